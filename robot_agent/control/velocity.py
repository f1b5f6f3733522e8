"""The simplest law: u_i = k (v_c - v_i), each robot for itself, and (3.35) to keep clear."""

from __future__ import annotations

from collections.abc import Sequence

from protocol.scenario import RobotScenario
from robot_agent.control.repulsion import keep_clear
from robot_agent.hand import Own, top_acceleration
from robot_agent.interfaces import Controller, Fresh, Plan, Point
from robot_agent.neighbours import Placed


class VelocityControl(Controller):
    """Takes the velocity of the plan; k is `walk.gain`, 1/s."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._gain = scenario.walk.gain
        self._potential = scenario.repulsion
        self._top = top_acceleration(scenario.body)

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        u = (self._gain * (plan.v_c[0] - own.vx), self._gain * (plan.v_c[1] - own.vy))
        return keep_clear(u, own, others, self._potential, self._top)
