"""The cooperative law of chapter 3.

Thesis (3.34): u_i = v_c' + phi_i + sig(phi_i)^a,  phi_i = sum_j a_ij (v_j - v_i) + delta (v_c^i - v_i),
with (3.35) to keep apart. Departs from the thesis: (3.35) is added to (3.34) within d_0, not put in its place
(`repulsion.form`): as printed d_0 = 6.6 > d = 4 leaves the group in the potential for ever. v_c' = 0 between decisions.
"""

from __future__ import annotations

from collections.abc import Sequence

from protocol.scenario import RobotScenario
from robot_agent.control.repulsion import anyone_within, gradient_force
from robot_agent.hand import Own
from robot_agent.interfaces import Controller, Fresh, Plan, Point
from robot_agent.neighbours import Placed
from robot_agent.sig import STEPS


class SimpleControl(Controller):
    """(3.34) with (3.35)."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._p = scenario.simple
        self._potential = scenario.repulsion
        self._K = 2.0 * scenario.max_degree + self._p.delta
        self._step = STEPS[scenario.control.step]

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        p, potential = self._p, self._potential
        if potential.form == "switch" and anyone_within(own.x, own.y, others, potential.d0):
            return gradient_force(own.x, own.y, others, potential, potential.d0)
        phi_x = p.delta * (plan.v_c[0] - own.vx)
        phi_y = p.delta * (plan.v_c[1] - own.vy)
        for a_ij, s in fresh:
            phi_x += a_ij * (s.vx - own.vx)
            phi_y += a_ij * (s.vy - own.vy)
        dt_k = dt * self._K
        fx, fy = gradient_force(own.x, own.y, others, potential, potential.d0)
        return self._step(phi_x, 1.0, 1.0, p.a, dt_k) + fx, self._step(phi_y, 1.0, 1.0, p.a, dt_k) + fy
