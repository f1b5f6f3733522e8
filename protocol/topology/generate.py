"""Topologies that are generated: in one direction, at random, by distance.

Rules: a draw is addressed by the edge that it is for, so that a graph depends on its seed and nothing else; who asks for
more neighbours gets the same edges and further ones. What is not connected is refused with what would do.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import dist

from protocol.errors import ScenarioError
from protocol.randomness import rng_for
from protocol.scenario.graph_options import OF_THE_RUN
from protocol.scenario.scenario import Scenario
from protocol.scenario.start import start_points

Pairs = Iterable[tuple[int, int]]


def directed_ring(scenario: Scenario) -> Pairs:
    """Each listens to the one before it, robot 0 to the last: 0 -> 1 -> ... -> N-1 -> 0."""
    n = scenario.robots
    return [(i, (i - 1) % n) for i in range(n)] if n > 1 else []


def random(scenario: Scenario) -> Pairs:
    """A random tree, so that all hang together, and then any further pairs until the mean degree is reached.

    The tree: the robots come in a random order, each is linked to one of those before it. `graph_options.mean_degree`
    asks for round(N mean_degree / 2) links; fewer than N-1 are made N-1, more than there are make everyone.
    """
    n, options = scenario.robots, scenario.graph_options
    seed = scenario.seed if options.seed == OF_THE_RUN else options.seed
    order = sorted(range(n), key=lambda i: rng_for(seed, "graph", "order", i).uniform())
    tree = set()
    for k in range(1, n):
        earlier = order[int(k * rng_for(seed, "graph", "parent", k).uniform())]
        tree.add((min(order[k], earlier), max(order[k], earlier)))
    more = round(n * options.mean_degree / 2) - len(tree)
    if more <= 0:
        return sorted(tree)
    others = [(i, j) for i in range(n) for j in range(i + 1, n) if (i, j) not in tree]
    others.sort(key=lambda pair: rng_for(seed, "graph", "edge", *pair).uniform())
    return sorted(tree | set(others[:more]))


def k_nearest(scenario: Scenario) -> Pairs:
    """Each with the `graph_options.nearest` robots that are nearest to it at the start; a link needs only one of the two
    to be near for the other. Of robots equally far the lower number is the nearer.

    Raises: ScenarioError when the graph is not connected.
    """
    n, k, points = scenario.robots, scenario.graph_options.nearest, start_points(scenario)
    if len(points) != n:
        raise ScenarioError(f"start.positions has {len(points)} points and robots is {n}; k-nearest needs one per robot.")
    ranked = [sorted((j for j in range(n) if j != i), key=lambda j: dist(points[i], points[j])) for i in range(n)]
    pairs = _nearest(ranked, k)
    if not _connected(n, pairs):
        least = next(more for more in range(k + 1, n) if _connected(n, _nearest(ranked, more)))
        raise ScenarioError(
            f'topology "k-nearest" with graph_options.nearest = {k} falls apart where the robots start; it must be at least'
            f" {least}."
        )
    return pairs


def _nearest(ranked: list[list[int]], k: int) -> list[tuple[int, int]]:
    return sorted({(min(i, j), max(i, j)) for i, near in enumerate(ranked) for j in near[:k]})


def _connected(n: int, pairs: Pairs) -> bool:
    import networkx as nx

    graph: nx.Graph[int] = nx.Graph(pairs)
    graph.add_nodes_from(range(n))
    return bool(nx.is_connected(graph))
