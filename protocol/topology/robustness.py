"""How many liars a graph lets the resilient fusion withstand.

A node of a set S is r-reached when it listens to at least r nodes outside S. A graph is (r, s)-robust when for any two
disjoint nonempty sets all nodes of one are r-reached from outside it, or all of the other, or s of both together; with
s = 1 it is called r-robust. W-MSR (robot_agent.resilient) with F agrees among the honest in spite of
    F liars in all, if and only if the graph is (F+1, F+1)-robust; F in every neighbourhood, if it is (2F+1)-robust.
Source: LeBlanc et al. 2013, as named in robot_agent.resilient, definitions 13 and 15, theorems 1 and 2.

Rules: exact, by looking at all sets: N 2^N steps, so for small N only; numpy is loaded when it is needed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from protocol.topology.graph import Graph

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Counts = NDArray[np.int64]

MOST = 14  # robots: 16,384 sets


@dataclass(frozen=True, slots=True)
class Robustness:
    """What is exact for a graph of at most MOST robots."""

    r: int  # largest r for which the graph is r-robust
    liars: int  # largest F for which it is (F+1, F+1)-robust: so many liars in all are withstood


def robustness(graph: Graph) -> Robustness | None:
    """How robust `graph` is; None where that cannot be found out in time."""
    n = graph.robots
    if n > MOST:
        return None
    s = [largest_s(graph, r) for r in range(1, (n + 1) // 2 + 1)]
    return Robustness(
        r=max((r for r, most in enumerate(s, start=1) if most >= 1), default=0),
        liars=max((f for f, most in enumerate(s) if most >= f + 1), default=0),
    )


def largest_s(graph: Graph, r: int) -> int:
    """Largest s up to N for which `graph` is (r, s)-robust; 0: it is not r-robust."""
    import numpy as np

    n = graph.robots
    sets = np.arange(1 << n)
    inside = [(sets >> node) & 1 for node in range(n)]
    reached = np.zeros(1 << n, dtype=np.int64)  # X_r(S): how many of S are r-reached
    for node in range(n):
        outside = sum((1 - inside[j] for j in graph.neighbours(node)), start=np.zeros(1 << n, dtype=np.int64))
        reached += inside[node] * (outside >= r)
    size = sum(inside, start=np.zeros(1 << n, dtype=np.int64))
    many = n + 1  # no obstacle: more than any s
    own = np.where((size > 0) & (reached < size), reached, many)  # sets that are not reached in all their nodes
    least = _least_within(own, n)
    together = own + least[(1 << n) - 1 - sets]  # S and the worst set that is disjoint from it
    # (r, s)-robust if and only if no such pair has less than s nodes reached.
    return int(min(together.min(), n))


def _least_within(own: Counts, n: int) -> Counts:
    """For every set the least of `own` over its subsets."""
    import numpy as np

    least = own.copy()
    for node in range(n):
        halves = least.reshape(-1, 2, 1 << node)  # without the node, with it
        halves[:, 1] = np.minimum(halves[:, 1], halves[:, 0])
    return least
