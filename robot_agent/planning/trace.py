"""The movement plan along the plume.

Thesis section 3.4.1, (3.32):
    p_x = h_x + |x - h_x| / 2
    p_y = h_y + sign(w_y) |x - h_x| / 2 |w_y| / w_x
where x is the robot's own x and w the local wind. The plan is a point downwind of the decided source, so that the robot
keeps meeting the plume. After 20 s without a detection in the group the plan is the decided source itself.

Departs from the thesis: |w_x| for w_x, and the slope |w_y / w_x| is bounded (switches `planning.slope`,
`planning.slope_limit`): as printed it changes sign with w_x and is singular at w_x = 0. The speed of the plan is always
`planning.speed` (Remark 10 and the search times ask for it); the rates are differences over one decision.
"""

from __future__ import annotations

from math import cos, hypot, pi, sin

from protocol.scenario import RobotScenario
from robot_agent.hand import Own
from robot_agent.interfaces import LOST, TRACE, Plan, Planner, Point


class TracePlanner(Planner):
    """Plans along the plume, towards the decided source when the plume is lost."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._planning = scenario.planning
        self._share = (scenario.robot + 1) / scenario.robots
        self._dt = scenario.timing.decision
        self._last: Point | None = None
        self._p_dot: Point = (0.0, 0.0)

    def plan(self, own: Own, h: Point, lost: bool) -> Plan:
        if lost and self._planning.lost == "circle":
            return self._circling(own, h)
        target = h if lost else self._downwind(own, h)
        if self._last is None:
            self._last = (own.x, own.y)
        p_dot = scaled(target[0] - self._last[0], target[1] - self._last[1], self._planning.speed)
        p_ddot = ((p_dot[0] - self._p_dot[0]) / self._dt, (p_dot[1] - self._p_dot[1]) / self._dt)
        self._last, self._p_dot = target, p_dot
        v_c = scaled(target[0] - own.x, target[1] - own.y, self._planning.speed)
        if not lost and self._planning.passed == "upwind" and self._has_passed(own, target):
            v_c = scaled(-own.wind_x, -own.wind_y, self._planning.speed)
        return Plan(LOST if lost else TRACE, target, p_dot, p_ddot, v_c, centre=h)

    @staticmethod
    def _has_passed(own: Own, target: Point) -> bool:
        """Whether the robot is upwind of its target."""
        return (own.x - target[0]) * own.wind_x + (own.y - target[1]) * own.wind_y < 0.0

    def _circling(self, own: Own, h: Point) -> Plan:
        """The plan goes round h on a circle of this robot's own, as (5.6) does with the robots."""
        p = self._planning
        radius, theta = p.circle * self._share, 2.0 * pi * self._share + p.turn * own.t
        x, y = radius * cos(theta), radius * sin(theta)
        w2 = p.turn**2
        target = (h[0] + x, h[1] + y)
        self._last, self._p_dot = target, (-p.turn * y, p.turn * x)
        v_c = scaled(target[0] - own.x, target[1] - own.y, p.speed)
        return Plan(LOST, target, self._p_dot, (-w2 * x, -w2 * y), v_c, centre=h)

    def _downwind(self, own: Own, h: Point) -> Point:
        w_x, w_y = own.wind_x, own.wind_y
        half = abs(own.x - h[0]) / 2.0
        if self._planning.slope == "magnitude":
            w_x = abs(w_x)
        slope = abs(w_y) / w_x if w_x != 0.0 else 0.0
        limit = self._planning.slope_limit
        if limit > 0.0:
            slope = max(-limit, min(limit, slope))
        sign = (w_y > 0.0) - (w_y < 0.0)
        return h[0] + half, h[1] + sign * half * slope


def scaled(x: float, y: float, length: float) -> Point:
    """The vector (x, y) brought to `length`; 0 stays 0."""
    size = hypot(x, y)
    return (x * length / size, y * length / size) if size > 1e-9 else (0.0, 0.0)
