"""Probability PSO with an information-sharing mechanism (PPSO-IM), constructed from what is known of it.

[Lu & Han 2011] could not be read. SOURCED (thesis sections 1.1.5, 2.3, 4.5.2): it uses concentrations only; an estimation
of distribution gives each robot "an opportunity to choose an appropriate position"; in this group's architecture the swarm
decides and the consensus law (2.7) moves. INFERRED: everything below. Do not take it for a replication.

Each robot tells, and passes on, where it met its highest concentration: x_l,j and C_j of every robot j. A Gaussian is fit to
these places,
    w_j = C_j / sum C,   m = sum w_j x_l,j,   S = stretch^2 sum w_j (x_l,j - m)(x_l,j - m)^T + floor^2 I,
and every `sampling` seconds p_i is with probability P the PSO centre (2.4), otherwise a draw from N(m, S). Without the
stretch the swarm closes up where it stands: in a narrow plume the concentration along the middle rises by a few times only
from one end of the arena to the other, less than it changes from second to second, so that a best place of long ago is an
accident (`recall`) and what leads on is the line on which the best places lie.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

from protocol.randomness import rng_for
from protocol.scenario import RobotScenario
from robot_agent import particle
from robot_agent.decision.gossip import Gossip
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import Around, Decision, Fresh, Point
from robot_agent.kalman import Estimate
from robot_agent.particle import Sampling

Gaussian = tuple[Point, tuple[float, float, float]]  # mean, m; covariance xx, xy, yy, m^2


class PpsoImDecision(Decision):
    """h^ic = p_i: swarm centre or draw, anew every `ppso_im.sampling` seconds and held in between."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._s = scenario
        self._p = scenario.ppso_im
        self.recall = scenario.ppso_im.recall
        self._sampling = Sampling(scenario.ppso_im.sampling, scenario.timing.decision)
        self._bests = Gossip(scenario, 6)  # robot, now, concentration, when met, x_l
        self._decided((0.0, 0.0), 0.0)

    def begin(self, own: Own) -> None:
        self._decided((own.x, own.y), self._p.floor**2)

    def _decided(self, h: Point, variance: float) -> None:
        # Nothing is fused or filtered: what travels as the fusion state is the decision itself.
        self.h = self.state = h
        self.estimate = Estimate(*h, variance)

    def decide(self, own: Own, group: Group, detected: bool, around: Around) -> None:
        self.advance(around.fresh, 0.0)
        mine = group.own_best()
        if mine is not None:
            self._bests.offer((float(self._s.robot), own.t, mine.concentration, mine.at, mine.x, mine.y))
        if not self._sampling.due(own.t):
            return
        x_g = (group.best_x, group.best_y)
        (x, y), (xx, xy, yy) = fit(self._weighed(group) or [(1.0, x_g)], self._p.stretch, self._p.floor)
        draws = rng_for(self._s.seed, "ppso-im", self._s.robot, own.tick)
        if draws.uniform() < self._p.probability:
            alpha = particle.coefficients(self._s.seed, self._s.robot, own.tick, self._s.pso)
            p = particle.centre((mine.x, mine.y) if mine else (own.x, own.y), x_g, alpha)
        else:
            p = draw(((x, y), (xx, xy, yy)), draws.normal(), draws.normal())
        self._decided(particle.within(p, self._s.arena), 0.5 * (xx + yy))

    def advance(self, fresh: Fresh, dt: float) -> None:
        for _ in self._bests.hear(fresh):
            pass

    def notes(self, own: Own) -> tuple[float, ...]:
        return self._bests.notes(own)

    def _weighed(self, group: Group) -> list[tuple[float, Point]]:
        """(C_j, x_l,j) of all robots that have one that counts."""
        oldest = group.detected_at - self.recall if self.recall > 0.0 else 0.0
        return [(C, (x, y)) for _, _, C, at, x, y in self._bests.records() if at >= oldest]


def fit(weighed: Sequence[tuple[float, Point]], stretch: float, floor: float) -> Gaussian:
    """Weighted mean and stretched covariance of places, the covariance no smaller than floor^2 along any axis.

    Args:
        weighed: (weight > 0, place in m), at least one.
        stretch: what the standard deviations of the places are multiplied with.
        floor: m.
    """
    total = sum(w for w, _ in weighed)
    x = sum(w * p[0] for w, p in weighed) / total
    y = sum(w * p[1] for w, p in weighed) / total
    scale = stretch**2 / total
    xx = scale * sum(w * (p[0] - x) ** 2 for w, p in weighed) + floor**2
    yy = scale * sum(w * (p[1] - y) ** 2 for w, p in weighed) + floor**2
    xy = scale * sum(w * (p[0] - x) * (p[1] - y) for w, p in weighed)
    return (x, y), (xx, xy, yy)


def draw(gaussian: Gaussian, z_1: float, z_2: float) -> Point:
    """The point that two draws from N(0, 1) make of the Gaussian: m + L z, L L^T = S."""
    (x, y), (xx, xy, yy) = gaussian
    a = sqrt(xx)
    b = xy / a
    c = sqrt(max(0.0, yy - b * b))
    return x + a * z_1, y + b * z_1 + c * z_2
