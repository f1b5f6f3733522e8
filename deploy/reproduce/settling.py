"""How long the finite-time laws take: a bound that is proved, and a scale that is measured.

Rules: `settling_bound` never says less than the true time (of continuous time, unsaturated); `consensus_scale` is an
estimate and is called one. Both use homogeneity: with weights (2, 1 + a1) the laws have degree a1 - 1, so that what
holds on one level of a homogeneous function holds on all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from math import inf, sqrt

import numpy as np
from numpy.typing import NDArray

from protocol.errors import ScenarioError
from protocol.randomness import rng_for
from protocol.topology.graph import Graph
from robot_agent.control.homogeneous import Law

Array = NDArray[np.float64]

MARGIN = 1e-9  # what rounding may have done to a bound, relative
SHAPES = (1.0, 1.25, 1.5, 2.0, 3.0)  # q
MIXES = tuple(float(m) for m in np.geomspace(0.02, 2.0, 25))  # epsilon in units of the gains
SEARCH_CELLS, PROOF_CELLS = 300, 20000
LONGEST = 1000.0  # simulated s after which a consensus that has not settled is given up


@dataclass(frozen=True, slots=True)
class Certificate:
    """V = E^p + epsilon sig(e)^q w with V' <= -c V^g everywhere, for the law with unit gain k1 = 1."""

    q: float
    epsilon: float
    c: float
    g: float
    p: float

    def value(self, law: Law, e: float, w: float) -> float:
        """V at (e, w)."""
        return float(energy(law, e, w) ** self.p + self.epsilon * np.sign(e) * abs(e) ** self.q * w)

    def bound(self, law: Law, e: float, w: float) -> float:
        """T <= V(0)^(1-g) / (c (1-g)), Lemma 1 of the thesis, s."""
        return float(self.value(law, e, w) ** (1.0 - self.g) / (self.c * (1.0 - self.g)))


def energy(law: Law, e: float, w: float) -> float:
    """E = k1 |e|^(1+a1) / (1+a1) + w^2 / 2, which never grows; of degree 2 (1+a1)."""
    return float(law.k1 * abs(e) ** (1.0 + law.a1) / (1.0 + law.a1) + 0.5 * w * w)


def unsaturated_energy(law: Law) -> float:
    """Below this E, and for ever after, no term of the law saturates."""
    edge = (law.s1 / law.k1) ** (1.0 / law.a1)
    return min(energy(law, edge, 0.0), energy(law, 0.0, (law.s2 / law.k2) ** (1.0 / law.a2)))


def settling_bound(law: Law, e: float, w: float) -> float:
    """No trajectory of e' = w, w' = -k1 sig(e)^a1 - k2 sig(w)^a2 from (e, w) takes longer to (0, 0), s.

    V = E^p + epsilon sig(e)^q w, p = (2q + 1 + a1) / (2 + 2 a1), is homogeneous and, for epsilon small enough, positive;
    V' <= -c V^g with g = (2q + 2 a1) / (2q + 1 + a1) < 1 holds everywhere if it holds on the curve E = 1. There it is
    verified by interval arithmetic, cell by cell, so that c is proved and not sampled. Lemma 1 gives the time; the best
    of a grid of (q, epsilon) is taken. For two axes the longer of both counts.

    Args:
        law: gains; a1 in (0, 1).
        e: position error at the start, m.
        w: velocity error at the start, m/s.
    Raises: ScenarioError where the law saturates on the way: the bound speaks of the unsaturated law.
    """
    if e == 0.0 and w == 0.0:
        return 0.0
    if energy(law, e, w) > unsaturated_energy(law):
        raise ScenarioError(
            f"settling_bound: from e = {e:g} m, w = {w:g} m/s the law may saturate; the bound holds where "
            f"k1 |e|^(1+a1)/(1+a1) + w^2/2 <= {unsaturated_energy(law):.3g}. Start nearer or raise the limits."
        )
    # sample first, to find the most promising (q, epsilon); then prove the best of them
    found = [(each.bound(law, e, w), each) for each in _candidates(law.a1, law.k1, law.k2)]
    for _, each in sorted(found, key=lambda pair: pair[0]):
        c = _rate(law, each.q, each.epsilon, PROOF_CELLS)
        if c > 0.0:
            return Certificate(each.q, each.epsilon, c, each.g, each.p).bound(law, e, w) * (1.0 + MARGIN)
    raise ScenarioError(f"settling_bound: no Lyapunov function of its family fits {law}; bring k2 nearer to k1.")


@cache
def _candidates(a1: float, k1: float, k2: float) -> tuple[Certificate, ...]:
    law = Law(a1, k1, k2)
    found = []
    for q in SHAPES:
        degree = 2.0 * q + 1.0 + a1
        p, g = degree / (2.0 + 2.0 * a1), (degree + a1 - 1.0) / degree
        edge = ((1.0 + a1) / k1) ** (1.0 / (1.0 + a1))  # |e| on E = 1 at w = 0
        for mix in MIXES:
            epsilon = mix / (edge**q * sqrt(2.0))
            c = _rate(law, q, epsilon, SEARCH_CELLS)
            if c > 0.0:
                found.append(Certificate(q, epsilon, c, g, p))
    return tuple(found)


def _rate(law: Law, q: float, epsilon: float, cells: int) -> float:
    """A lower bound of -V' / V^g on E = 1; not positive where there is none.

    On each quarter of the curve, e = +-edge cos^(2/(1+a1)), w = sqrt(2) sin, all powers are monotone in the angle, so that
    their values at the ends of a cell enclose them.
    """
    a1, a2, k1, k2 = law.a1, law.a2, law.k1, law.k2
    degree = 2.0 * q + 1.0 + a1
    p, g = degree / (2.0 + 2.0 * a1), (degree + a1 - 1.0) / degree
    edge = ((1.0 + a1) / k1) ** (1.0 / (1.0 + a1))
    angle = np.linspace(0.0, 0.5 * np.pi, cells + 1)
    cosine = np.cos(angle)
    cosine[-1] = 0.0
    e, w = edge * cosine ** (2.0 / (1.0 + a1)), sqrt(2.0) * np.sin(angle)  # falling, rising
    e_hi, e_lo, w_lo, w_hi = e[:-1], e[1:], w[:-1], w[1:]
    worst = inf
    for side in (1.0, -1.0):  # the sign of e . w
        cross_lo, cross_hi = _ordered(side * e_lo**q * w_lo, side * e_hi**q * w_hi)
        v_lo, v_hi = 1.0 + epsilon * cross_lo, 1.0 + epsilon * cross_hi
        # -V' = p k2 |w|^(1+a2) + epsilon (k1 |e|^(q+a1) + k2 sig(e)^q sig(w)^a2 - q |e|^(q-1) w^2)
        mixed_lo, _ = _ordered(side * e_lo**q * w_lo**a2, side * e_hi**q * w_hi**a2)
        down = p * k2 * w_lo ** (1.0 + a2)
        down = down + epsilon * (k1 * e_lo ** (q + a1) + k2 * mixed_lo - q * e_hi ** (q - 1.0) * w_hi**2)
        if v_lo.min() <= MARGIN:
            return -inf
        worst = min(worst, float((down / np.where(down > 0.0, v_hi, v_lo) ** g).min()))
    return worst * (1.0 - MARGIN) if worst > 0.0 else worst


def _ordered(a: Array, b: Array) -> tuple[Array, Array]:
    return np.minimum(a, b), np.maximum(a, b)


def consensus_scale(graph: Graph, law: Law, starts: int = 64, dt: float = 0.002, seed: int = 0) -> float:
    """The longest settling time seen from E = 1 under dcs-ft's consensus on `graph`, s: a NUMERICAL bound, not a proof.

    E = sum over the edges of a_ij k1 |x_ij|^(1+a1) / (1+a1) + 1/2 sum |v_i - mean v|^2 has degree 2 (1+a1), so that
    T(x, v) = E^((1-a1)/(2+2a1)) T(direction of (x, v)):  settling times from anywhere follow from those on E = 1
    (`consensus_time`). The directions are a random sample, so that a longer one may have been missed.

    What runs is the same law in arrays over all starts at once; the robots' own function would be many times slower. A run
    ends at E = 1e-12, and what is left is added by homogeneity.

    Raises: ScenarioError for a graph that is not undirected and connected, where no theorem holds.
    """
    A = np.array(graph.adjacency())
    n = len(A)
    laplacian = np.diag(A.sum(1)) - A
    if not graph.is_symmetric() or n < 2 or float(np.linalg.eigvalsh(laplacian)[1]) < 1e-9:
        raise ScenarioError("consensus_scale: the graph must be undirected and connected, with two robots or more.")
    a1, a2, k1, k2 = law.a1, law.a2, law.k1, law.k2
    power, end = (1.0 - a1) / (2.0 + 2.0 * a1), 1e-12
    draws = rng_for(seed, "consensus-scale", n)
    x, v = (np.array([[2.0 * draws.uniform() - 1.0 for _ in range(n)] for _ in range(starts)]) for _ in range(2))
    v *= np.array([[10.0 ** (2.0 * draws.uniform() - 1.0)] for _ in range(starts)])  # from mostly apart to mostly moving
    grow = consensus_energy(A, law, x, v) ** (-1.0 / (2.0 + 2.0 * a1))
    x, v = x * grow[:, None] ** 2, v * grow[:, None] ** (1.0 + a1)
    times = np.full(starts, inf)
    t = 0.0
    while not np.isfinite(times).all():
        if t > LONGEST:
            raise ScenarioError(f"consensus_scale: not settled after {LONGEST:g} s; choose k1 and k2 nearer to each other.")
        apart, drift = x[:, None, :] - x[:, :, None], v[:, None, :] - v[:, :, None]  # (starts, i, j): j minus i
        f = k1 * np.sign(apart) * np.abs(apart) ** a1 + k2 * np.sign(drift) * np.abs(drift) ** a2
        v = v + dt * (A * f).sum(2)
        x = x + dt * v
        t += dt
        times[(consensus_energy(A, law, x, v) < end) & np.isinf(times)] = t
    return float(times.max() / (1.0 - end**power))


def consensus_energy(A: Array, law: Law, x: Array, v: Array) -> Array:
    """E of each state; x and v of shape (..., N), m and m/s."""
    a1 = law.a1
    apart = np.abs(x[..., None, :] - x[..., :, None])
    stretched = 0.5 * law.k1 * (A * apart ** (1.0 + a1)).sum((-2, -1)) / (1.0 + a1)
    moving = 0.5 * ((v - v.mean(-1, keepdims=True)) ** 2).sum(-1)
    return np.asarray(stretched + moving)


def consensus_time(scale: float, graph: Graph, law: Law, x: Sequence[float], v: Sequence[float]) -> float:
    """Settling time from (x, v), s, given `consensus_scale`."""
    E = float(consensus_energy(np.array(graph.adjacency()), law, np.array(x), np.array(v)))
    return float(scale * E ** ((1.0 - law.a1) / (2.0 + 2.0 * law.a1)))
