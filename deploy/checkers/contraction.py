"""Disagreement of the fusion stayed within its bound while the graph was connected.

With E = 1/2 sum_{i<j} a_ij |y_i - y_j|^2 on a graph that is symmetric, connected and heard without loss or delay at this
tick, and no measurement coming in, one implicit step of the fusion (3.26) at all robots gives

    E(k+1) <= (1 - c lambda_2) E(k),      c = dt / (1 + dt K),   K = 2 max_degree.

Proof. On each axis y+ = y - C z with z = L y and a diagonal C whose entries lie between c and 1/K: the implicit step
moves by dt s' = (phi_0 - phi_1) / K <= phi_0 / K, and at least by the linear part alone, phi_0 dt / (1 + dt K), since the
term in beta has its sign. Then E+ = E - z'Cz + 1/2 (Cz)'L(Cz), and L <= K (Gershgorin) makes the last term at most
1/2 z'Cz. So E+ <= E - 1/2 c |z|^2, and |z|^2 = y'L^2 y >= lambda_2 y'Ly = 2 lambda_2 E.  (The term in beta only makes it
faster: that it is finite-time is the business of the tests of the fusion.)

The premises are looked at tick by tick; ticks without them promise nothing here. A neighbour whose words are not what it
holds (a liar) breaks a premise, too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from itertools import groupby

import numpy as np

from deploy.checkers import hull
from deploy.checkers.finding import Facts
from deploy.checkers.graph import Declared
from deploy.checkers.history import History, Life
from protocol.history.records import Acted, Point, Sent

ROUNDING = 1e-9
Edges = tuple[tuple[int, int, float], ...]


def disagreement_shrinks(history: History) -> Facts:
    """A fact for every tick that has the premises."""
    told = {(life.robot, s.tick): s for lives in history.lives.values() for life in lives for s in life.sent}
    K = 2.0 * Declared(history.scenario).max_degree
    c = history.dt / (1.0 + history.dt * K)
    for tick, group in groupby(history.acts(), key=lambda pair: pair[1].tick):
        acts = list(group)
        edges = _premises(acts, told)
        if edges is None:
            continue
        before = {life.robot: told[life.robot, tick].fusion for life, _ in acts}
        after = {life.robot: act.fusion for life, act in acts if act.fusion is not None}
        e_0, e_1 = _energy(edges, before), _energy(edges, after)
        bound = (1.0 - c * lambda_2(edges)) * e_0
        if e_1 <= bound + ROUNDING * (e_0 + ROUNDING * _size(before)):
            yield None
        else:
            says = f"the robots' disagreement went from {e_0:.6g} to {e_1:.6g} m² {history.when(tick)}"
            yield f"{says}; on this connected graph it must be at most {bound:.6g}"


def _premises(acts: Sequence[tuple[Life, Acted]], told: Mapping[tuple[int, int], Sent]) -> Edges | None:
    """The edges of a tick at which everybody exchanged with everybody on a symmetric, connected graph, or None."""
    robots = {life.robot for life, _ in acts}
    if len(robots) != len(acts) or len(robots) < 2:
        return None
    edges: dict[tuple[int, int], float] = {}
    for life, act in acts:
        own = told.get((life.robot, act.tick))
        if own is None or not own.begun or act.fusion is None or act.mind is None or act.mind.input is not None:
            return None
        for j, age, a_ij, y_j in act.used:
            state = told.get((j, act.tick))
            if age != 0 or j not in robots or state is None or y_j != state.fusion:
                return None
            edges[life.robot, j] = a_ij
    if any(edges.get((j, i)) != a_ij for (i, j), a_ij in edges.items()):
        return None
    found = tuple(sorted((i, j, a_ij) for (i, j), a_ij in edges.items()))
    return found if {i for i, _, _ in found} == robots and lambda_2(found) > ROUNDING else None


@lru_cache(maxsize=256)
def lambda_2(edges: Edges) -> float:
    """Second smallest eigenvalue of the Laplacian of a symmetric graph; 0 when it is not connected."""
    number = {i: n for n, i in enumerate(sorted({i for i, _, _ in edges}))}
    A = np.zeros((len(number), len(number)))
    for i, j, a_ij in edges:
        A[number[i], number[j]] = a_ij
    return float(np.linalg.eigvalsh(np.diag(A.sum(axis=1)) - A)[1])


def _energy(edges: Edges, y: Mapping[int, Point]) -> float:
    return 0.5 * sum(
        a_ij * ((y[i][0] - y[j][0]) ** 2 + (y[i][1] - y[j][1]) ** 2) for i, j, a_ij in edges if i < j
    )


def _size(y: Mapping[int, Point]) -> float:
    return sum(x * x + z * z for x, z in y.values())


def not_promised(history: History) -> str | None:
    """Why this run did not promise it."""
    if history.scenario.clock == "realtime":
        return "in real time the robots do not step together"
    return hull.not_promised(history)
