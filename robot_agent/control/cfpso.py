"""The PSO-based finite-time law of chapter 4 (CFPSO).

Thesis (4.12): u_i = -gamma phi_i - beta sig(phi_i)^a + p_i'',  phi_i = (1-omega)(v_i - p_i') + alpha (x_i - p_i).

Departs from the thesis: (3.35) is added when somebody is within d (`cfpso.repulsion`).
"""

from __future__ import annotations

from collections.abc import Sequence

from protocol.scenario import RobotScenario
from robot_agent.control.repulsion import keep_clear
from robot_agent.hand import Own, top_acceleration
from robot_agent.interfaces import Controller, Fresh, Plan, Point
from robot_agent.neighbours import Placed
from robot_agent.sig import STEPS


class CfpsoControl(Controller):
    """(4.12), each robot for itself; the neighbours matter only to keep clear of them."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._p = scenario.cfpso
        self._potential = scenario.repulsion
        self._top = top_acceleration(scenario.body)
        self._step = STEPS[scenario.control.step]

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        p = self._p
        inertia = 1.0 - p.omega
        phi_x = inertia * (own.vx - plan.p_dot[0]) + p.alpha * (own.x - plan.target[0])
        phi_y = inertia * (own.vy - plan.p_dot[1]) + p.alpha * (own.y - plan.target[1])
        dt_k = dt * (inertia + dt * p.alpha)
        u = (
            plan.p_ddot[0] - self._step(phi_x, p.gamma, p.beta, p.a, dt_k),
            plan.p_ddot[1] - self._step(phi_y, p.gamma, p.beta, p.a, dt_k),
        )
        return keep_clear(u, own, others, self._potential, self._top) if p.repulsion else u
