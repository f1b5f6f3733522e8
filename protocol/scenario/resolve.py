"""From the name of a topology to the graph itself, so that the scenario is complete.

Rules: a graph that is there stays; nothing else of the scenario changes, but for `robots` where the topology fixes it.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import msgspec

from protocol.errors import ScenarioError
from protocol.scenario.scenario import Scenario
from protocol.scenario.settings import where
from protocol.topology.find import find_graph, size_fault

_DEFAULT_ROBOTS = Scenario().robots
_NO_ORIGINS: Mapping[str, str] = {}


def resolve(
    scenario: Scenario,
    base_dir: Path = Path(),
    *,
    robots_given: bool | None = None,
    origins: Mapping[str, str] = _NO_ORIGINS,
) -> Scenario:
    """`scenario` with its `graph` filled in from `topology`.

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
    try:
        graph = find_graph(scenario.topology, scenario.robots, base_dir)
    except ScenarioError as error:
        raise ScenarioError(where(origins, "topology") + str(error)) from None
    if given and graph.robots != scenario.robots:
        fault = size_fault(scenario.topology, graph.robots, scenario.robots)
        raise ScenarioError(where(origins, "topology", "robots") + fault)
    return msgspec.structs.replace(scenario, robots=graph.robots, graph=graph.edges)
