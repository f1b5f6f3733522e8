"""The topologies that have a name.

Rules: a new topology is one function of the number of robots and one line of TOPOLOGIES; networkx builds, it is loaded
when the first graph is built.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from protocol.topology.graph import Graph, make_graph

Pairs = Iterable[tuple[int, int]]  # undirected edges, each once


def everyone(n: int) -> Pairs:
    """Everyone with everyone."""
    import networkx as nx

    pairs: Pairs = nx.complete_graph(n).edges()
    return pairs


def ring(n: int) -> Pairs:
    """0 - 1 - ... - N-1 - 0; two robots make a line, one makes nothing."""
    import networkx as nx

    pairs: Pairs = nx.cycle_graph(n).edges() if n > 2 else line(n)
    return pairs


def line(n: int) -> Pairs:
    """0 - 1 - ... - N-1."""
    import networkx as nx

    pairs: Pairs = nx.path_graph(n).edges()
    return pairs


def star(n: int) -> Pairs:
    """Robot 0 with everyone else."""
    import networkx as nx

    pairs: Pairs = nx.star_graph(n - 1).edges()
    return pairs


@dataclass(frozen=True, slots=True)
class Topology:
    """How a named graph is built, and for how many robots if only for so many."""

    edges: Callable[[int], Pairs]
    about: str
    robots: int | None = None


TOPOLOGIES: dict[str, Topology] = {
    "all": Topology(everyone, "everyone with everyone"),
    "ring": Topology(ring, "each with the next, the last with the first"),
    "line": Topology(line, "each with the next"),
    "star": Topology(star, "robot 0 with everyone"),
    "fig-3.2": Topology(ring, "four robots in a ring (section 3.3.3, Example 2)", robots=4),
    "fig-5.3": Topology(line, "three robots in a line (sections 5.2 and 5.3)", robots=3),
    "fig-5.18": Topology(everyone, "three robots, all linked (section 5.3)", robots=3),
}


def build(name: str, robots: int) -> Graph:
    """The topology `name` of `robots` robots, all weights 1."""
    return make_graph(robots, TOPOLOGIES[name].edges(robots), directed=False)
