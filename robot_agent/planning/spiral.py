"""The spiral from a robot's place inwards to the decided position.

Thesis (2.8):  p_i(k') = R(theta_1) (a e^(b theta) cos theta - a, a e^(b theta) sin theta) + h^ic(k),
(2.9):  theta_max = (1/b) log(r/a),  r = |p_i(k) - h^ic(k)|,  theta(k') = theta(k'-1) - 0.1 from theta_max down to 0.

theta_1 = theta_11 - theta_12 turns the end of the spiral towards the robot: theta_11 is the angle of p_i - h and theta_12
that of (cos theta_max, sin theta_max), which is theta_max itself. The quadrant rules printed for both are those of atan2
inside the quadrants; on the axes p_ix = h_ix, and p_iy = h_iy with p_ix > h_ix, they divide by 0 or turn the spiral round
by pi, so atan2 it is. Since a is taken off along x before the turn, the spiral begins a = 0.1 m beside the robot and ends
in h. Where r < a, theta_max < 0 and there is no spiral: the plan is h.
"""

from __future__ import annotations

from math import atan2, ceil, cos, exp, hypot, log, sin

from protocol.scenario import RobotScenario
from protocol.scenario.laws import Spiral
from robot_agent.hand import Own
from robot_agent.interfaces import LOST, TRACE, Plan, Planner, Point
from robot_agent.planning.trace import scaled


class SpiralPlanner(Planner):
    """Winds in upon h^ic, anew from where the robot is whenever h^ic changes."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._p = scenario.spiral
        self._speed = scenario.planning.speed
        self._ticks = max(1, round(scenario.spiral.period / scenario.timing.tick))
        self._h: Point | None = None
        self._from: Point = (0.0, 0.0)
        self._tick = 0  # of k' = 0

    def plan(self, own: Own, h: Point, lost: bool) -> Plan:
        if h != self._h:
            self._h, self._from, self._tick = h, (own.x, own.y), own.tick
        return self._at(own, LOST if lost else TRACE)

    def follow(self, own: Own, plan: Plan) -> Plan:
        return self._at(own, plan.mode)

    def _at(self, own: Own, mode: str) -> Plan:
        h = self._h or (own.x, own.y)
        target = spiral(self._from, h, (own.tick - self._tick) // self._ticks, self._p)
        v_c = scaled(target[0] - own.x, target[1] - own.y, self._speed)
        return Plan(mode, target, v_c=v_c, centre=h)


def spiral(start: Point, h: Point, k: int, p: Spiral) -> Point:
    """p_i(k') of (2.8), k' = `k` steps after the robot was at `start` = p_i(k), m."""
    x, y = start[0] - h[0], start[1] - h[1]
    r = hypot(x, y)
    if r <= p.a:
        return h
    theta_max = log(r / p.a) / p.b  # (2.9)
    theta = theta_max - p.turn * k
    if theta <= 0.0:
        return h
    theta_1 = atan2(y, x) - theta_max
    radius = p.a * exp(p.b * theta)
    s_x, s_y = radius * cos(theta) - p.a, radius * sin(theta)
    c, s = cos(theta_1), sin(theta_1)
    return c * s_x - s * s_y + h[0], s * s_x + c * s_y + h[1]


def steps(r: float, p: Spiral) -> int:
    """How many steps k' a spiral from the distance r takes to end in h."""
    return ceil(log(r / p.a) / p.b / p.turn) if r > p.a else 0
