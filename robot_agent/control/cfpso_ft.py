"""CFPSO with a finite-time law: (4.12) made homogeneous.

    u_i = p_i'' + sat(k1 sig(p_i - x_i)^a1) + sat(k2 sig(p_i' - v_i)^a2),     a2 = 2 a1 / (1 + a1), each axis for itself.

Theorem (robot_agent.control.homogeneous; Bhat & Bernstein 1998, 2005): for p_i twice differentiable with the p_i', p_i''
given, x_i = p_i and v_i = p_i' from a finite time on, from any start, with or without sat. Needs nothing of the neighbours.
A bound on the settling time: `deploy.reproduce.settling.settling_bound`.

What the body leaves of it: the limits add up to what the wheels can give, and the position term pulls no harder than the
velocity term brakes at (position_limit / k2)^(1/a2) m/s; wheels that are told to turn as well, and a speed at its
limit of 0.8 m/s, still cut u_i, so that for the body the claim is local. The planner's p_i jumps once a second and its p_i'
has the magnitude of the top speed (Remark 10), so that in a search the robot follows a plan, it does not settle.
Departs from the thesis: all of it is ours; (3.35) is added when somebody is within d (`cfpso_ft.repulsion`).
"""

from __future__ import annotations

from collections.abc import Sequence

from protocol.scenario import RobotScenario
from robot_agent.control.homogeneous import Law, pull
from robot_agent.control.repulsion import keep_clear
from robot_agent.hand import Own, top_acceleration
from robot_agent.interfaces import Controller, Fresh, Plan, Point
from robot_agent.neighbours import Placed


class CfpsoFtControl(Controller):
    """Each robot for itself; the neighbours matter only to keep clear of them."""

    def __init__(self, scenario: RobotScenario) -> None:
        p = scenario.cfpso_ft
        self._law = Law(p.a1, p.k1, p.k2, p.position_limit, p.velocity_limit)
        self._repulsion = p.repulsion
        self._potential = scenario.repulsion
        self._top = top_acceleration(scenario.body)
        self._implicit = scenario.control.step == "implicit"

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        held = dt if self._implicit else 0.0
        (p_x, p_y), (pd_x, pd_y) = plan.target, plan.p_dot
        u = (
            plan.p_ddot[0] + pull(self._law, p_x - own.x, pd_x - own.vx, held, 1.0),
            plan.p_ddot[1] + pull(self._law, p_y - own.y, pd_y - own.vy, held, 1.0),
        )
        return keep_clear(u, own, others, self._potential, self._top) if self._repulsion else u
