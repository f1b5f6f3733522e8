"""A robot's row of the graph as it is declared now.

Rules: pure; a robot knows its declared graph and the common simulated time, so it knows which stage of a schedule rules
and with which weights. Who is within the radio's range it cannot know: of a stage with a range the row holds all who
could be near enough, and `Reading.hears` names those who are, in lock-step and in real time.
"""

from __future__ import annotations

from collections.abc import Mapping

from protocol.scenario import RobotScenario
from protocol.scenario.stage import stage_at

Weights = Mapping[int, float]  # a_ij by neighbour j


class Row:
    """Whom robot i listens to and with what weight, at any tick."""

    __slots__ = ("_dt", "_period", "_rows", "_starts", "switches")

    def __init__(self, scenario: RobotScenario) -> None:
        self._dt = scenario.timing.tick
        self._period = scenario.period
        self._starts = [stage.at for stage in scenario.stages]
        self._rows: list[Weights] = [dict(stage.row) for stage in scenario.stages] or [dict(scenario.row)]
        self.switches = len(self._rows) > 1

    def weights(self, tick: int) -> Weights:
        """a_ij of the stage that rules at `tick`."""
        return self._rows[stage_at(self._starts, self._period, tick * self._dt) if self.switches else 0]
