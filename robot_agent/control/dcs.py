"""The consensus-based finite-time law of chapter 5 (DCS), Algorithm 2.

Thesis (5.5), parallel motion:  u_i = v_ic' + phi_i + sig(phi_i)^alpha,
    phi_i = sum_j a_ij (beta ((x_j - h_j) - (x_i - h_i)) + gamma (v_j - v_i)) + lambda (v_ic - v_i)
and (5.7), circular motion:  u_i = h_i'' + phi_i + sig(phi_i)^alpha,
    phi_i = sum_j a_ij (beta ((x_j - h_j) - (x_i - h_i)) + gamma ((v_j - h_j') - (v_i - h_i')))
            + lambda_1 (h_i' - v_i) + lambda_2 (h^ic - (x_i - h_i)),   h_i = r (cos theta_i, sin theta_i).

Departs from the thesis: the circular motion belongs to a lost plume (`dcs.order`; Algorithm 2 prints it the other way
round than the text and Algorithm 5); h_i at 2 pi i / N (`dcs.sectors`); theta_i = 2 pi i / N + omega_0 t by the common
simulated time, so that no phase has to be agreed; omega_0 such that r omega_0 can be driven (`dcs.turn`); (3.35) is
added when somebody is within `dcs.clearance` (`dcs.repulsion`).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi

from msgspec.structs import replace

from protocol.scenario import RobotScenario
from robot_agent.control.consensus_laws import circular, formation, orbit, parallel, relative, respond
from robot_agent.control.repulsion import keep_clear
from robot_agent.hand import Own, top_acceleration
from robot_agent.interfaces import LOST, SEARCH, Controller, Fresh, Plan, Point
from robot_agent.neighbours import Placed
from robot_agent.sig import STEPS


class DcsControl(Controller):
    """(5.5) while the group traces, (5.7) while it is lost."""

    def __init__(self, scenario: RobotScenario) -> None:
        p = scenario.dcs
        self._p = p
        self._robots = scenario.robots
        self._me = scenario.robot
        self._potential = replace(scenario.repulsion, d=p.clearance)
        self._top = top_acceleration(scenario.body)
        sectors = p.sectors or scenario.robots
        # h_i of Table 5.3; robots are numbered from 1 in the thesis.
        self._h = formation(p.radius, sectors, scenario.robots)
        self._K = 2.0 * scenario.max_degree * p.gamma
        self._step = STEPS[scenario.control.step]

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        circular = plan.mode == LOST if self._p.order == "algorithm-5" else plan.mode not in (LOST, SEARCH)
        u = self._circle(own, fresh, plan, dt) if circular else self._parallel(own, fresh, plan, dt)
        return keep_clear(u, own, others, self._potential, self._top) if self._p.repulsion else u

    def _parallel(self, own: Own, fresh: Fresh, plan: Plan, dt: float) -> Point:
        p = self._p
        here = relative(own, self._h[self._me])
        heard = [(a_ij, relative(s, self._h[s.robot])) for a_ij, s in fresh]
        phi = parallel(here, heard, plan.v_c, p.beta, p.gamma, p.lam)
        return respond(phi, p.alpha, self._step, dt * (self._K + p.lam))

    def _circle(self, own: Own, fresh: Fresh, plan: Plan, dt: float) -> Point:
        p = self._p
        h, h_dot = self._orbit(self._me, own.t)
        heard = [(a_ij, relative(s, *self._orbit(s.robot, own.t))) for a_ij, s in fresh]
        phi = circular(relative(own, h, h_dot), heard, plan.centre, p.beta, p.gamma, p.lam1, p.lam2)
        u_x, u_y = respond(phi, p.alpha, self._step, dt * (self._K + p.lam1))
        w2 = p.turn**2
        return u_x - w2 * h[0], u_y - w2 * h[1]

    def _orbit(self, i: int, t: float) -> tuple[Point, Point]:
        """h_i and h_i' of (5.6) at time t."""
        p = self._p
        share = (i + 1) / self._robots
        radius = p.circle * share if p.orbits == "spread" else p.circle
        return orbit(radius, p.turn, 2.0 * pi * share + p.turn * t)
