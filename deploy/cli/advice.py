"""What a person ought to know before a run begins, although nothing in it is an error.

Rules: each piece of advice is one or two sentences for stderr; a run that is as it should be gets none.
"""

from __future__ import annotations

from collections.abc import Iterator

from protocol.scenario import Scenario
from protocol.scenario.schema import get_value
from robot_agent.algorithms import ALGORITHMS


def advice(scenario: Scenario) -> Iterator[str]:
    """Sentences about `scenario`, which is complete and checked."""
    parts = ALGORITHMS[scenario.algorithm]
    if parts.gains:
        yield from _gains(scenario, parts.gains)
    if scenario.fusion.kind == "resilient":
        yield from _liars(scenario)
    if parts.drill and scenario.plume.release_rate > 0:
        yield (
            f'"{scenario.algorithm}" is an exercise that ignores the odour, and there is a source: the run ends when a robot'
            " comes upon it. --set plume.release_rate=0 leaves it out."
        )


def _liars(scenario: Scenario) -> Iterator[str]:
    from protocol.topology.graph import Graph
    from protocol.topology.robustness import robustness

    found = robustness(Graph(scenario.robots, scenario.graph))
    if found is not None and found.liars < scenario.fusion.liars:
        yield (
            f"fusion.liars is {scenario.fusion.liars}, and {scenario.topology} of {scenario.robots} robots withstands"
            f" {found.liars}: honest robots may not agree, with or without a liar. `odourswarm topology` says what a graph"
            " withstands."
        )


def _gains(scenario: Scenario, table: str) -> Iterator[str]:
    from protocol.topology.analysis import analyse
    from protocol.topology.fit import fit_warning
    from protocol.topology.graph import Graph

    n = scenario.robots
    # A stage that is not connected may be mended by the others; whom the range will part nobody knows yet.
    stages = {stage.name: Graph(n, stage.edges) for stage in scenario.schedule if not stage.range}
    whole = Graph(n, scenario.graph)
    graphs = {scenario.topology: whole}
    if scenario.schedule and analyse(whole).connected:
        graphs = {name: graph for name, graph in stages.items() if analyse(graph).connected}
    beta, gamma = (float(str(get_value(scenario, f"{table}.{name}"))) for name in ("beta", "gamma"))
    for name, graph in graphs.items():
        sentence = fit_warning(analyse(graph), beta, gamma, table)
        if sentence is not None:
            yield f"{scenario.algorithm} on {name}, {n} robots: {sentence}"
