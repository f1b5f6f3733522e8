"""The topologies that have a name.

Rules: a new topology is one function of the scenario (most need only its number of robots) and one line of TOPOLOGIES;
networkx builds, it is loaded when the first graph is built.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import msgspec

from protocol.scenario.scenario import Scenario
from protocol.topology.generate import Pairs, directed_ring, k_nearest, random
from protocol.topology.graph import Graph, make_graph

_DEFAULT = Scenario()


def everyone(scenario: Scenario) -> Pairs:
    """Everyone with everyone."""
    import networkx as nx

    pairs: Pairs = nx.complete_graph(scenario.robots).edges()
    return pairs


def ring(scenario: Scenario) -> Pairs:
    """0 - 1 - ... - N-1 - 0; two robots make a line, one makes nothing."""
    import networkx as nx

    n = scenario.robots
    pairs: Pairs = nx.cycle_graph(n).edges() if n > 2 else line(scenario)
    return pairs


def line(scenario: Scenario) -> Pairs:
    """0 - 1 - ... - N-1."""
    import networkx as nx

    pairs: Pairs = nx.path_graph(scenario.robots).edges()
    return pairs


def star(scenario: Scenario) -> Pairs:
    """Robot 0 with everyone else."""
    import networkx as nx

    pairs: Pairs = nx.star_graph(scenario.robots - 1).edges()
    return pairs


@dataclass(frozen=True, slots=True)
class Topology:
    """How a named graph is built, and for how many robots if only for so many."""

    edges: Callable[[Scenario], Pairs]  # each once; of a directed graph (i, j): i listens to j
    about: str
    robots: int | None = None
    directed: bool = False
    ranged: bool = False  # only who is within `graph_options.range` is heard


TOPOLOGIES: dict[str, Topology] = {
    "all": Topology(everyone, "everyone with everyone"),
    "ring": Topology(ring, "each with the next, the last with the first"),
    "line": Topology(line, "each with the next"),
    "star": Topology(star, "robot 0 with everyone"),
    "k-nearest": Topology(k_nearest, "each with the graph_options.nearest nearest at the start"),
    "random": Topology(random, "a random tree and more, graph_options.mean_degree per robot"),
    "range-limited": Topology(everyone, "whoever is within graph_options.range metres now", ranged=True),
    "directed-ring": Topology(directed_ring, "each listens to the one before it", directed=True),
    "fig-3.2": Topology(ring, "four robots in a ring (section 3.3.3, Example 2)", robots=4),
    "fig-5.3": Topology(line, "three robots in a line (sections 5.2 and 5.3)", robots=3),
    "fig-5.18": Topology(everyone, "three robots, all linked (section 5.3)", robots=3),
}


def build(name: str, robots: int, scenario: Scenario = _DEFAULT) -> Graph:
    """The topology `name` of `robots` robots, all weights 1; `scenario` says what else it depends on.

    Raises: ScenarioError when it cannot be had.
    """
    topology = TOPOLOGIES[name]
    if scenario.robots != robots:
        scenario = msgspec.structs.replace(scenario, robots=robots)
    return make_graph(robots, topology.edges(scenario), directed=topology.directed)
