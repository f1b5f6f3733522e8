"""The communication graph: who listens to whom, with what weight.

Rules: robots are numbered from 0; an edge (i, j, a_ij) says that robot i listens to robot j; a graph is sorted and
without faults once it is made. Section 3.2 of the thesis: G = (nodes, E, A), A = [a_ij], a_ij >= 0.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING, Any

from protocol.errors import ScenarioError
from protocol.scenario.stage import Edge

if TYPE_CHECKING:
    import networkx

MOST_ROBOTS = 1000


@dataclass(frozen=True, slots=True)
class Graph:
    """Robots 0 to `robots` - 1 and their edges, sorted by (i, j); made by `make_graph`."""

    robots: int
    edges: tuple[Edge, ...]

    def adjacency(self) -> tuple[tuple[float, ...], ...]:
        """A, (N, N): row i holds the weights a_ij of what robot i hears."""
        rows = [[0.0] * self.robots for _ in range(self.robots)]
        for i, j, a_ij in self.edges:
            rows[i][j] = a_ij
        return tuple(tuple(row) for row in rows)

    def neighbours(self, i: int) -> tuple[int, ...]:
        """Robots that robot `i` listens to."""
        return tuple(j for k, j, _ in self.edges if k == i)

    def links(self) -> tuple[tuple[int, int], ...]:
        """The physical links (i, j), i < j: one wherever either robot listens to the other."""
        return tuple(sorted({(min(i, j), max(i, j)) for i, j, _ in self.edges}))

    def is_symmetric(self) -> bool:
        """Whether a_ij = a_ji everywhere: the thesis's undirected graph."""
        weights = {(i, j): a_ij for i, j, a_ij in self.edges}
        return all(weights.get((j, i)) == a_ij for (i, j), a_ij in weights.items())

    def to_networkx(self) -> networkx.DiGraph[int]:
        """The same graph for networkx: i -> j where i listens to j, attribute "weight" = a_ij."""
        import networkx as nx

        graph: networkx.DiGraph[int] = nx.DiGraph()
        graph.add_nodes_from(range(self.robots))
        graph.add_weighted_edges_from(self.edges)
        return graph


def make_graph(robots: int, edges: Iterable[Sequence[Any]], *, directed: bool = True) -> Graph:
    """The graph of `edges`, each (i, j) or (i, j, weight); weight 1 where none is given.

    Args:
        directed: False: an edge counts in both directions and is given once.
    Raises: ScenarioError with a sentence that does not say where the edges stood.
    """
    full = tuple((int(i), int(j), float(rest[0]) if rest else 1.0) for i, j, *rest in edges)
    fault = fault_in(robots, full, directed=directed)
    if fault is not None:
        raise ScenarioError(f"{fault}.")
    if not directed:
        full += tuple((j, i, a_ij) for i, j, a_ij in full)
    return Graph(robots, tuple(sorted(full)))


def fault_in(robots: int, edges: Iterable[Edge], *, directed: bool = True) -> str | None:
    """What is wrong with `edges`, as a sentence without its full stop, or None."""
    if not 1 <= robots <= MOST_ROBOTS:
        return f"there are {robots} robots; there must be 1 to {MOST_ROBOTS}"
    seen: set[tuple[int, int]] = set()
    for i, j, a_ij in edges:
        edge = f"edge [{i}, {j}]"
        for robot in (i, j):
            if not 0 <= robot < robots:
                return f"{edge} names robot {robot}; the robots must be numbered 0 to {robots - 1}"
        if i == j:
            return f"{edge} joins a robot to itself; an edge must join two robots"
        if not (isfinite(a_ij) and 0 < a_ij <= 1e9):
            return f"{edge} has weight {a_ij:g}; it must be a number > 0"
        if (i, j) in seen or (not directed and (j, i) in seen):
            return f"{edge} is given twice; every edge must be given once" + (
                "" if directed else ", for both directions"
            )
        seen.add((i, j))
    return None
