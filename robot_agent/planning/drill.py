"""The plans of the exercises: the references of the scenario's table `drill`, which every robot knows.

Rules: a plan does not depend on what is sensed; its target is what a picture shows, no law of an exercise uses it.
"""

from __future__ import annotations

from protocol.scenario import RobotScenario
from robot_agent.hand import Own
from robot_agent.interfaces import Plan, Planner, Point

DRILL = "drill"  # the mode of these plans


class NoReference(Planner):
    """No reference: the robots agree among themselves, (5.1) and (5.3)."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._drill = scenario.drill
        self._dt = scenario.timing.decision

    def plan(self, own: Own, h: Point, lost: bool) -> Plan:
        return Plan(DRILL, (own.x, own.y))


class VelocityReference(NoReference):
    """The reference velocity v_c of (5.4)."""

    def plan(self, own: Own, h: Point, lost: bool) -> Plan:
        v_c = self._drill.velocity
        return Plan(DRILL, (own.x + self._dt * v_c[0], own.y + self._dt * v_c[1]), v_c=v_c)


class CentreReference(NoReference):
    """The centre h^c of (5.6)."""

    def plan(self, own: Own, h: Point, lost: bool) -> Plan:
        return Plan(DRILL, self._drill.centre, centre=self._drill.centre)
