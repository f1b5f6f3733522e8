"""The controller of `plume-map`: to the own place in the line, with the line's velocity.

    v = sat(v_c + k_p (p_i - x_i)),  u_i = k_v (v - v_i),  behind (3.35) at arm's length and the barrier (keep_clear).
During the search p_i is the own position, so that the common heading alone is followed.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from msgspec.structs import replace

from protocol.scenario import RobotScenario
from robot_agent.control.repulsion import keep_clear
from robot_agent.hand import Own, top_acceleration
from robot_agent.interfaces import SEARCH, Controller, Fresh, Plan, Point
from robot_agent.neighbours import Placed


class BracketControl(Controller):
    """k_p is `plume_map.pull`, k_v `plume_map.gain`."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._p = scenario.plume_map
        self._potential = replace(scenario.repulsion, d=max(self._p.clearance, 1e-3))
        self._top = top_acceleration(scenario.body)

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        p = self._p
        vx, vy = plan.v_c
        if plan.mode != SEARCH:
            vx += p.pull * (plan.target[0] - own.x)
            vy += p.pull * (plan.target[1] - own.y)
        speed = hypot(vx, vy)
        if speed > p.speed:
            vx, vy = vx * p.speed / speed, vy * p.speed / speed
        u = (p.gain * (vx - own.vx), p.gain * (vy - own.vy))
        return keep_clear(u, own, others, self._potential, self._top)
