"""No decision: an exercise has references that are given and no source to find."""

from __future__ import annotations

from protocol.scenario import RobotScenario
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import Around, Decision, Fresh, Point
from robot_agent.kalman import Estimate


class Undecided(Decision):
    """Decides nothing, tells nothing."""

    decides = False

    def __init__(self, scenario: RobotScenario) -> None:
        self.state: Point = (0.0, 0.0)
        self.h: Point = (0.0, 0.0)
        self.estimate = Estimate(0.0, 0.0, 0.0)

    def begin(self, own: Own) -> None:
        """Nothing begins."""

    def decide(self, own: Own, group: Group, detected: bool, around: Around) -> None:
        """There is nothing to decide."""

    def advance(self, fresh: Fresh, dt: float) -> None:
        """There is nothing to agree on."""
