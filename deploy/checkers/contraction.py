"""Disagreement of the fusion stayed within its bound while the graph was connected.

With the inputs u_i of this tick held, (3.26) goes down the gradient of

    E(y) = 1/2 sum_{i<j} a_ij |y_i - y_j|^2 + 1/2 sum_i lambda_i |u_i - y_i|^2,   H = L + diag(lambda_i),

to its minimum y*, the best compromise between the measurements (any common value when nobody measures). The excess
D = 1/2 (y - y*)' H (y - y*) is the disagreement that can be taken away. On a graph that is symmetric, connected and heard
without loss or delay at this tick, one implicit step at all robots gives, with mu the smallest eigenvalue of H > 0,

    D(k+1) <= (1 - c mu) D(k),    c = dt / (1 + dt K),   K = 2 max_degree + lam.

Proof. On each axis y+ = y - C z with z = H (y - y*) and a diagonal C: the implicit step moves robot i by dt s' =
(phi_0 - phi_1) / K_i, K_i = 2 max_degree + lambda_i, so by at most phi_0 / K_i, and at least by what the linear part does
alone, phi_0 dt / (1 + dt K_i), since the term in beta has its sign: c <= c_i <= 1/K_i. Then D+ = D - z'Cz + 1/2 (Cz)'H(Cz);
by Gershgorin H <= diag(K_i), so the last term is at most 1/2 z'Cz. Hence D+ <= D - 1/2 c |z|^2, and |z|^2 >= 2 mu D. (The
term in beta only makes it faster: that it is finite-time is the business of the tests of the fusion.)

The premises are looked at tick by tick; ticks without them promise nothing here. A neighbour whose words are not what it
holds (a liar) breaks a premise, too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from deploy.checkers import hull
from deploy.checkers.finding import Facts
from deploy.checkers.graph import Declared
from deploy.checkers.history import History, Life
from protocol.history.records import Acted, Sent

Array = NDArray[np.float64]
Edges = tuple[tuple[int, int, float], ...]  # a_ij by numbers of rows
ROUNDING = 1e-9  # relative to D, and of a size of y squared: of what rounding leaves of D


def disagreement_shrinks(history: History) -> Facts:
    """A fact for every tick that has the premises."""
    told = {(life.robot, s.tick): s for lives in history.lives.values() for life in lives for s in life.sent}
    lam = history.scenario.fusion.lam
    K = 2.0 * Declared(history.scenario).max_degree + lam
    c = history.dt / (1.0 + history.dt * K)
    for tick, group in groupby(history.acts(), key=lambda pair: pair[1].tick):
        acts = list(group)
        edges = _premises(acts, told)
        if edges is None:
            continue
        inputs = [act.mind.input if act.mind is not None else None for _, act in acts]
        lams = tuple(0.0 if u is None else lam for u in inputs)
        H, mu, _ = spectrum(edges, lams)
        y_0 = np.array([told[life.robot, tick].fusion for life, _ in acts])
        y_1 = np.array([act.fusion for _, act in acts])
        if any(lams):
            y_star = np.linalg.solve(H, np.array([[0.0, 0.0] if u is None else [lam * u[0], lam * u[1]] for u in inputs]))
        else:
            y_star = y_0.mean(axis=0)
        d_0, d_1 = _excess(H, y_0 - y_star), _excess(H, y_1 - y_star)
        bound = (1.0 - c * mu) * d_0
        if d_1 <= bound + ROUNDING * (d_0 + ROUNDING * float((y_0**2).sum() + (y_star**2).sum())):
            yield None
        else:
            says = f"the robots' disagreement went from {d_0:.6g} to {d_1:.6g} m² {history.when(tick)}"
            yield f"{says}; on this connected graph it must be at most {bound:.6g}"


def _premises(acts: Sequence[tuple[Life, Acted]], told: Mapping[tuple[int, int], Sent]) -> Edges | None:
    """The edges of a tick at which all exchanged on a symmetric, connected graph, or None."""
    row = {life.robot: n for n, (life, _) in enumerate(acts)}
    if len(row) != len(acts) or len(row) < 2:
        return None
    edges: dict[tuple[int, int], float] = {}
    for life, act in acts:
        own = told.get((life.robot, act.tick))
        if own is None or not own.begun or act.fusion is None:
            return None
        for j, age, a_ij, y_j in act.used:
            state = told.get((j, act.tick))
            if age != 0 or j not in row or state is None or y_j != state.fusion:
                return None
            edges[row[life.robot], row[j]] = a_ij
    if any(edges.get((j, i)) != a_ij for (i, j), a_ij in edges.items()):
        return None
    found = tuple(sorted((i, j, a_ij) for (i, j), a_ij in edges.items()))
    connected = spectrum(found, (0.0,) * len(acts))[2]
    return found if connected else None


@lru_cache(maxsize=1024)
def spectrum(edges: Edges, lams: tuple[float, ...]) -> tuple[Array, float, bool]:
    """H, its smallest eigenvalue > 0, and whether the graph is connected."""
    A = np.zeros((len(lams), len(lams)))
    for i, j, a_ij in edges:
        A[i, j] = a_ij
    L = np.diag(A.sum(axis=1)) - A
    connected = bool(np.linalg.eigvalsh(L)[1] > ROUNDING)
    H = L + np.diag(lams)
    return H, float(np.linalg.eigvalsh(H)[0 if any(lams) else 1]), connected


def _excess(H: Array, e: Array) -> float:
    """D, m^2."""
    return 0.5 * float(np.einsum("ia,ij,ja->", e, H, e))


def not_promised(history: History) -> str | None:
    """Why this run did not promise it."""
    fusion = history.scenario.fusion
    if history.scenario.clock == "realtime":
        return "in real time the robots do not step together"
    if fusion.kind != "plain":
        return f'fusion.kind is "{fusion.kind}": what it leaves out of the sums is not the same for all'
    return hull.not_promised(history)
