"""A decision that is sure of a given place some time after the odour was met: what declares can be tested without a map."""

from __future__ import annotations

from math import hypot

from protocol.scenario import RobotScenario
from robot_agent.algorithms import Algorithm
from robot_agent.control.cfpso import CfpsoControl
from robot_agent.decision.dda import DistributedDecision
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import Around, BeliefMap
from robot_agent.planning.trace import TracePlanner

PLACE = (10.3, 0.0)  # what it holds the source for; it is at (10, 0)
AFTER = 2.0  # s from the first detection until it is sure
ROWS, COLUMNS, CELL = 4, 5, 2.0


class SureDecision(DistributedDecision):
    """h^ic is a given place, and certain after a while."""

    def __init__(self, scenario: RobotScenario) -> None:
        super().__init__(scenario)
        self._radius: float | None = None

    def decide(self, own: Own, group: Group, detected: bool, around: Around) -> None:
        super().decide(own, group, detected, around)
        self.h = PLACE
        self._radius = 5.0 if own.t < group.first_detected_at + AFTER else 0.1

    def certainty(self) -> float | None:
        return self._radius

    def belief_map(self) -> BeliefMap | None:
        if self._radius is None:
            return None
        near = (255.0 / (1.0 + hypot(column - 2, row - 1)) for row in range(ROWS) for column in range(COLUMNS))
        return PLACE[0] - 5.0, PLACE[1] - 3.0, CELL, ROWS, bytes(map(int, near))


SURE = Algorithm("is told where the source is", SureDecision, TracePlanner, CfpsoControl, declares=True)
