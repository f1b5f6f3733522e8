"""DCS with finite-time laws: (5.5) and (5.7) made homogeneous, edge by edge.

With xbar_i = x_i - h_i and f of robot_agent.control.homogeneous, a2 = 2 a1 / (1 + a1), each axis for itself:

parallel motion   u_i = v_ic' + sum_j a_ij [sat(k1 sig(xbar_j - xbar_i)^a1) + sat(k2 sig(v_j - v_i)^a2)]
                        + sat(k3 sig(v_ic - v_i)^a2)
circular motion   u_i = h_i'' + sum_j a_ij [sat(k1 sig(xbar_j - xbar_i)^a1) + sat(k2 sig(vbar_j - vbar_i)^a2)]
                        + sat(k4 sig(h^ic - xbar_i)^a1) + sat(k5 sig(h_i' - v_i)^a2)

Theorem: on an undirected connected graph, for 0 < a1 < 1 and positive gains, k3 >= 0, and one v_c (h^c) that all robots
have, xbar_i = xbar_j and v_i = v_j (= v_c if k3 > 0; xbar_i = h^c in circular motion) from a finite time on, from any
start. Proof: E = sum over the edges of a_ij integral of sat(k1 sig(.)^a1), plus that of k4, plus 1/2 sum |v_i - v_c|^2 (for
k3 = 0: minus their mean, which every edge leaves as it is) does not grow; where it stands still all v_i agree, so all u_i
do, their sum says that they are 0, and sum_i xbar_i . u_i = 0 says that every edge is at rest. Asymptotic stability and
homogeneity of degree a1 - 1 < 0 make it finite-time [Bhat & Bernstein 2005]; with sat it holds from any start as well, for
E brings the state to where no term saturates. The unsaturated law is of the kind of Wang & Hong, "Finite-time consensus
for multi-agent networks with second-order agent dynamics", IFAC World Congress, 2008 (from memory; not seen). A saturated
protocol is the subject of "Finite-time consensus for second-order multi-agent systems with saturated control protocols"
(IET Control Theory & Applications, about 2015; only its abstract seen). The proof above does not rest on either.
Robots with references of their own (Remark 23) do not agree in finite time, nor at all: they stay within what their
references differ by. Nor is anything proved for switching or directed graphs.

Needs of the neighbours: x_j, v_j. All edges of a graph are pulled in one tick, so that K = 2 max_i sum_j a_ij (Gershgorin)
and 1 for the reference; it is the same for all robots, so that an edge pulls its ends alike and the mean is kept.
No settling time is proved for more than two robots: `deploy.reproduce.settling.consensus_scale` measures one.
Departs from the thesis: all of it is ours; formation, orbit and what is done when the plume is lost are those of
robot_agent.control.dcs; (3.35) is added when somebody is within `dcs_ft.clearance`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import pi

from msgspec.structs import replace

from protocol.scenario import RobotScenario
from robot_agent.control.consensus_laws import Motion, formation, orbit, relative
from robot_agent.control.homogeneous import Law, damp, pull
from robot_agent.control.repulsion import keep_clear
from robot_agent.hand import Own, top_acceleration
from robot_agent.interfaces import LOST, Controller, Fresh, Plan, Point
from robot_agent.neighbours import Placed


def agreement(own: Motion, heard: Iterable[tuple[float, Motion]], law: Law, dt: float, K: float) -> Point:
    """sum_j a_ij f(xbar_j - xbar_i, vbar_j - vbar_i) per axis, m/s^2: the finite-time form of (5.1) and (5.3)."""
    u_x = u_y = 0.0
    for a_ij, j in heard:
        u_x += a_ij * pull(law, j.x - own.x, j.vx - own.vx, dt, K)
        u_y += a_ij * pull(law, j.y - own.y, j.vy - own.vy, dt, K)
    return u_x, u_y


class DcsFtControl(Controller):
    """Parallel motion while the group traces, circular motion while it is lost."""

    def __init__(self, scenario: RobotScenario) -> None:
        p = scenario.dcs_ft
        self._p = p
        self._me = scenario.robot
        self._robots = scenario.robots
        degree = scenario.max_degree
        share = max(degree, 1e-9)  # the limits are for all neighbours together
        self._edge = Law(p.a1, p.k1, p.k2, p.position_limit / share, p.velocity_limit / share)
        self._v_c = Law(p.a1, 0.0, p.k3, 0.0, 2.0 * p.reference_limit)
        self._orbit_law = Law(p.a1, p.k4, p.k5, p.reference_limit, p.reference_limit)
        self._K = 2.0 * degree + 1.0
        self._h = formation(p.radius, p.sectors or scenario.robots, scenario.robots)
        self._potential = replace(scenario.repulsion, d=p.clearance)
        self._top = top_acceleration(scenario.body)
        self._implicit = scenario.control.step == "implicit"

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        held = dt if self._implicit else 0.0
        u = self._circle(own, fresh, plan, held) if plan.mode == LOST else self._parallel(own, fresh, plan, held)
        return keep_clear(u, own, others, self._potential, self._top) if self._p.repulsion else u

    def _parallel(self, own: Own, fresh: Fresh, plan: Plan, dt: float) -> Point:
        heard = [(a_ij, relative(s, self._h[s.robot])) for a_ij, s in fresh]
        u_x, u_y = agreement(relative(own, self._h[self._me]), heard, self._edge, dt, self._K)
        return (
            u_x + damp(self._v_c, plan.v_c[0] - own.vx, dt, self._K),
            u_y + damp(self._v_c, plan.v_c[1] - own.vy, dt, self._K),
        )

    def _circle(self, own: Own, fresh: Fresh, plan: Plan, dt: float) -> Point:
        h, h_dot = self._place(self._me, own.t)
        here = relative(own, h, h_dot)
        heard = [(a_ij, relative(s, *self._place(s.robot, own.t))) for a_ij, s in fresh]
        u_x, u_y = agreement(here, heard, self._edge, dt, self._K)
        w2 = self._p.turn**2
        return (
            u_x + pull(self._orbit_law, plan.centre[0] - here.x, -here.vx, dt, self._K) - w2 * h[0],
            u_y + pull(self._orbit_law, plan.centre[1] - here.y, -here.vy, dt, self._K) - w2 * h[1],
        )

    def _place(self, i: int, t: float) -> tuple[Point, Point]:
        """h_i and h_i' of (5.6) at time t."""
        p = self._p
        share = (i + 1) / self._robots
        radius = p.circle * share if p.orbits == "spread" else p.circle
        return orbit(radius, p.turn, 2.0 * pi * share + p.turn * t)
