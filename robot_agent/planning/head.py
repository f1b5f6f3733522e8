"""The plan of those who decide where to drive themselves: straight to h at full speed."""

from __future__ import annotations

from protocol.scenario import RobotScenario
from robot_agent.hand import Own
from robot_agent.interfaces import TRACE, Plan, Planner, Point
from robot_agent.planning.trace import scaled


class HeadPlanner(Planner):
    """Heads for h; slower in the last second of the way, so that it comes to rest there."""

    def __init__(self, speed: float) -> None:
        self._speed = speed

    def plan(self, own: Own, h: Point, lost: bool) -> Plan:
        dx, dy = h[0] - own.x, h[1] - own.y
        v_c = (dx, dy) if dx * dx + dy * dy < self._speed**2 else scaled(dx, dy, self._speed)
        return Plan(TRACE, h, p_dot=v_c, v_c=v_c, centre=h)


def surge_planner(scenario: RobotScenario) -> HeadPlanner:
    """At the speed of the surge."""
    return HeadPlanner(scenario.surge.speed)


def walk_planner(scenario: RobotScenario) -> HeadPlanner:
    """At the speed of the walk."""
    return HeadPlanner(scenario.walk.speed)
