"""From the name of a topology, or a schedule of names, to the edges themselves, so that the scenario is complete.

Rules: a graph that is there stays; nothing else of the scenario changes, but for `robots` where the topology fixes it.
The graph of a schedule is the union of its stages: the physical links.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import msgspec

from protocol.errors import ScenarioError
from protocol.scenario.scenario import Scenario
from protocol.scenario.settings import where
from protocol.scenario.stage import Edge, Stage, label
from protocol.topology.find import find_graph, size_fault
from protocol.topology.graph import Graph, fault_in
from protocol.topology.named import TOPOLOGIES

_DEFAULT_ROBOTS = Scenario().robots
_NO_ORIGINS: Mapping[str, str] = {}


def resolve(
    scenario: Scenario,
    base_dir: Path = Path(),
    *,
    robots_given: bool | None = None,
    origins: Mapping[str, str] = _NO_ORIGINS,
) -> Scenario:
    """`scenario` with its `graph` filled in from `topology`, or from the stages of its schedule, which get their edges.

    Args:
        base_dir: where the path of a graph file starts from.
        robots_given: whether `robots` was asked for; None: yes when it is not the default. A topology of a fixed size
            (fig-5.3: 3) sets `robots` when it was not.
        origins: where each value was given, for the sentence.
    Raises: ScenarioError for an unknown topology, an unreadable file, or a size that is not the one asked for.
    """
    if scenario.graph:
        return scenario
    given = scenario.robots != _DEFAULT_ROBOTS if robots_given is None else robots_given
    stages = scenario.schedule or (Stage(0.0, scenario.topology),)
    robots = scenario.robots if given else _fixed_size(stages, scenario.robots)
    try:
        graphs = [_graph(stage, robots, base_dir, scenario) for stage in stages]
    except ScenarioError as error:
        raise ScenarioError(where(origins, "topology") + str(error)) from None
    if not given:
        robots = graphs[0].robots
    for stage, graph in zip(stages, graphs, strict=True):
        if graph.robots != robots:
            fault = size_fault(stage.name, graph.robots, robots)
            raise ScenarioError(where(origins, "topology", "robots") + fault)
    filled = tuple(_filled(stage, graph, scenario) for stage, graph in zip(stages, graphs, strict=True))
    switching = bool(scenario.schedule) or any(stage.range > 0.0 for stage in filled)
    # The ranges that were filled in are part of a schedule's name: written down and read again it is the same scenario.
    name = label(filled) if scenario.schedule else scenario.topology
    edges = union(stage.edges for stage in filled)
    return msgspec.structs.replace(
        scenario, robots=robots, topology=name, graph=edges, schedule=filled if switching else ()
    )


def union(graphs: Iterable[Iterable[Edge]]) -> tuple[Edge, ...]:
    """All edges of `graphs`, each once with the largest weight that it has anywhere."""
    weights: dict[tuple[int, int], float] = {}
    for graph in graphs:
        for i, j, a_ij in graph:
            weights[i, j] = max(a_ij, weights.get((i, j), 0.0))
    return tuple((i, j, a_ij) for (i, j), a_ij in sorted(weights.items()))


def _fixed_size(stages: Iterable[Stage], default: int) -> int:
    """The number of robots that some stage fixes by its name."""
    sizes = (TOPOLOGIES[stage.name].robots for stage in stages if stage.name in TOPOLOGIES)
    return next((size for size in sizes if size is not None), default)


def _graph(stage: Stage, robots: int, base_dir: Path, scenario: Scenario) -> Graph:
    if not stage.edges:
        return find_graph(stage.name, robots, base_dir, scenario)
    fault = fault_in(robots, stage.edges)
    if fault is not None:
        raise ScenarioError(f"the stage at {stage.at:g} s: {fault}.")
    return Graph(robots, tuple(sorted(stage.edges)))


def _filled(stage: Stage, graph: Graph, scenario: Scenario) -> Stage:
    """`stage` with its edges, and with the range of a topology that is limited by it."""
    ranged = stage.name in TOPOLOGIES and TOPOLOGIES[stage.name].ranged
    reach = stage.range or (scenario.graph_options.range if ranged else 0.0)
    return msgspec.structs.replace(stage, range=reach, edges=graph.edges)
