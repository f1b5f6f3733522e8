"""A robot's row of the graph as it is declared now.

Rules: pure; a robot knows its declared graph and the common simulated time, so it knows which stage of a schedule rules
and with which weights. Who is within the radio's range it cannot know: that it is told in `Reading.hears`.

In lock-step `hears` names exactly the states to wait for, and `weights(tick)` is all that is needed. In real time, where
a robot acts on the latest state of each neighbour, it listens at every tick to `listens_to(tick, hears)`, the row without
those that the world says are out of range, and leaves out what came from anybody else. The world must therefore fill in
`Reading.hears` in real time, too; the ticks in it do not matter then.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from protocol.scenario import RobotScenario
from protocol.scenario.stage import stage_at

Weights = Mapping[int, float]  # a_ij by neighbour j


class Row:
    """Whom robot i listens to and with what weight, at any tick."""

    __slots__ = ("_dt", "_period", "_rows", "_stages", "_starts")

    def __init__(self, scenario: RobotScenario) -> None:
        stages = scenario.stages
        self._dt = scenario.timing.tick
        self._period = scenario.period
        self._starts = [stage.at for stage in stages]
        self._stages = stages
        self._rows: list[Weights] = [dict(stage.row) for stage in stages] or [dict(scenario.row)]

    def weights(self, tick: int) -> Weights:
        """a_ij of the stage that rules at `tick`; of a stage with a range, of all who could be near enough."""
        return self._rows[0] if len(self._rows) == 1 else self._rows[self._stage(tick)]

    def listens_to(self, tick: int, hears: Iterable[tuple[int, int]]) -> Weights:
        """`weights(tick)` of those who can be heard; `hears` is that of the latest reading."""
        weights = self.weights(tick)
        if not self._stages or not self._stages[self._stage(tick)].ranged:
            return weights
        near = {j for j, _ in hears}
        return {j: a for j, a in weights.items() if j in near}

    def _stage(self, tick: int) -> int:
        return stage_at(self._starts, self._period, tick * self._dt)
