"""The laws of chapter 5 one by one, as exercises with the references of the scenario's table `drill`.

Thesis: (5.1) consensus, (5.3) formation, (5.4) parallel motion, (5.6) circular motion; where every robot is given the
same reference, as here, (5.5) is (5.4) and (5.7) is (5.6). The formulas stand in `consensus_laws`.

Departs from the thesis: theta_i = 2 pi i / N + omega_0 t by the common simulated time (section 5.3 gives no phases);
(3.35) is added when somebody is within `drill.clearance` (`drill.repulsion`), so that under (5.1), which asks all
robots to one point, they gather around it.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi

from msgspec.structs import replace

from protocol.scenario import RobotScenario
from robot_agent.control.consensus_laws import agreement, circular, formation, orbit, parallel, relative, respond
from robot_agent.control.repulsion import keep_clear
from robot_agent.hand import Own, top_acceleration
from robot_agent.interfaces import Controller, Fresh, Plan, Point
from robot_agent.neighbours import Placed
from robot_agent.sig import STEPS


class ConsensusDrill(Controller):
    """(5.1): all robots to one place and one velocity; no reference."""

    def __init__(self, scenario: RobotScenario) -> None:
        p = self._p = scenario.drill
        self._me = scenario.robot
        self._robots = scenario.robots
        self._potential = replace(scenario.repulsion, d=p.clearance)
        self._top = top_acceleration(scenario.body)
        self._step = STEPS[scenario.control.step]
        self._K = 2.0 * scenario.max_degree * p.gamma  # how fast phi_i answers to u, 1/s, at most
        self._h = [(0.0, 0.0)] * scenario.robots  # places in the formation, m

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        u = self._law(own, fresh, plan, dt)
        return keep_clear(u, own, others, self._potential, self._top) if self._p.repulsion else u

    def _law(self, own: Own, fresh: Fresh, plan: Plan, dt: float) -> Point:
        p, h = self._p, self._h
        heard = [(a_ij, relative(s, h[s.robot])) for a_ij, s in fresh]
        phi = agreement(relative(own, h[self._me]), heard, p.beta, p.gamma)
        return respond(phi, p.alpha, self._step, dt * self._K)


class FormationDrill(ConsensusDrill):
    """(5.3): one velocity, each robot at its place h_i of a circle of `drill.radius`; no reference."""

    def __init__(self, scenario: RobotScenario) -> None:
        super().__init__(scenario)
        p = scenario.drill
        self._h = formation(p.radius, p.sectors or scenario.robots, scenario.robots)


class ParallelDrill(FormationDrill):
    """(5.4): the formation moves at v_c, which is constant: v_c' = 0."""

    def _law(self, own: Own, fresh: Fresh, plan: Plan, dt: float) -> Point:
        p, h = self._p, self._h
        heard = [(a_ij, relative(s, h[s.robot])) for a_ij, s in fresh]
        phi = parallel(relative(own, h[self._me]), heard, plan.v_c, p.beta, p.gamma, p.lam)
        return respond(phi, p.alpha, self._step, dt * (self._K + p.lam))


class CircularDrill(ConsensusDrill):
    """(5.6): each robot circles h^c at its radius r_i, all at omega_0."""

    def _law(self, own: Own, fresh: Fresh, plan: Plan, dt: float) -> Point:
        p = self._p
        h, h_dot = self._orbit(self._me, own.t)
        heard = [(a_ij, relative(s, *self._orbit(s.robot, own.t))) for a_ij, s in fresh]
        phi = circular(relative(own, h, h_dot), heard, plan.centre, p.beta, p.gamma, p.lam1, p.lam2)
        u_x, u_y = respond(phi, p.alpha, self._step, dt * (self._K + p.lam1))
        w2 = p.turn**2
        return u_x - w2 * h[0], u_y - w2 * h[1]

    def _orbit(self, i: int, t: float) -> tuple[Point, Point]:
        """h_i and h_i' at time t."""
        p = self._p
        r = p.radii[i] if len(p.radii) > 1 else p.radii[0]
        return orbit(r, p.turn, 2.0 * pi * (i + 1) / self._robots + p.turn * t)
