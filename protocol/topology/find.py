"""The graph that a person means: a topology's name, or the path of a graph file.

Rules: names win over files; a sentence says what is known when neither is meant.
"""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path

from protocol.errors import ScenarioError
from protocol.scenario.scenario import Scenario
from protocol.scenario.schema import show
from protocol.topology.files import SUFFIXES, read_graph
from protocol.topology.graph import Graph
from protocol.topology.named import TOPOLOGIES, build

_DEFAULT = Scenario()


def find_graph(topology: str, robots: int, base_dir: Path = Path(), scenario: Scenario = _DEFAULT) -> Graph:
    """The graph called `topology`.

    Args:
        topology: a name, or the path of a graph file as seen from `base_dir`.
        robots: for how many robots, where the topology leaves that open; a figure or a file has its own number.
        scenario: what else a generated topology depends on.
    Raises: ScenarioError with a sentence that does not say where the name stood.
    """
    if topology in TOPOLOGIES:
        return build(topology, TOPOLOGIES[topology].robots or robots, scenario)
    if "/" in topology or Path(topology).suffix.lower() in SUFFIXES:
        return read_graph(base_dir / topology)
    near = get_close_matches(topology, TOPOLOGIES, n=1, cutoff=0.6)
    choice = f"give one of {', '.join(TOPOLOGIES)}, or a file that ends in {', '.join(SUFFIXES)}."
    raise ScenarioError(f"there is no topology {show(topology)}; " + (f'did you mean "{near[0]}"?' if near else choice))


def size_fault(topology: str, size: int, robots: int) -> str:
    """The sentence for `robots` robots asked for on a topology that has `size`."""
    return f"topology {show(topology)} has {size} robots and robots is {robots}; leave robots out, or make it {size}."
