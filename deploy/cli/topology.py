"""`odourswarm topology NAME`: the graph, drawn, with what its Laplacian says.

Rules: the graph comes from the code that the swarm uses, so that what is drawn is what will be linked.
"""

from __future__ import annotations

import json as json_format
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from deploy.cli.graph_png import save_png
from deploy.cli.graph_report import facts, print_report
from protocol.errors import ScenarioError
from protocol.scenario.scenario import Scenario
from protocol.scenario.settings import read_settings
from protocol.topology.analysis import analyse, gain_condition
from protocol.topology.find import find_graph, size_fault
from protocol.topology.graph import Graph
from protocol.topology.named import TOPOLOGIES


def topology(
    name: Annotated[str | None, typer.Argument(help="A topology, or a graph file; none: the list.")] = None,
    robots: Annotated[int | None, typer.Option("--robots", "-n", help="Number of robots N.")] = None,
    beta: Annotated[float | None, typer.Option("--beta", help="Position gain for condition (5.2).")] = None,
    gamma: Annotated[float | None, typer.Option("--gamma", help="Velocity gain for condition (5.2).")] = None,
    json: Annotated[bool, typer.Option("--json", help="One JSON object and nothing else.")] = False,
    png: Annotated[Path | None, typer.Option("--png", help="Draw the graph into an image file, too.")] = None,
) -> None:
    """Draw a communication graph; print its Laplacian's eigenvalues and whether the gains fit it."""
    console = Console(highlight=False)
    try:
        if name is None:
            _print_list(console, json=json)
            return
        dcs = Scenario().dcs
        graph = _graph(name, robots)
        condition_gains = (_gain("beta", beta, dcs.beta), _gain("gamma", gamma, dcs.gamma))
        analysis = analyse(graph)
        condition = gain_condition(analysis, *condition_gains)
        if png is not None:
            _save(graph, name, png)
    except ScenarioError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(2) from None
    if json:
        typer.echo(json_format.dumps(facts(name, graph, analysis, condition), allow_nan=False))
    else:
        print_report(console, name, graph, analysis, condition)


def _graph(name: str, robots: int | None) -> Graph:
    if robots is not None:
        list(read_settings(("robots",), robots, "--robots"))
    graph = find_graph(name, Scenario().robots if robots is None else robots)
    if robots is not None and graph.robots != robots:
        raise ScenarioError(f"--robots: {size_fault(name, graph.robots, robots)}")
    return graph


def _gain(name: str, value: float | None, default: float) -> float:
    if value is None:
        return default
    (setting,) = read_settings(("dcs", name), value, f"--{name}")
    assert isinstance(setting.value, float)
    return setting.value


def _save(graph: Graph, name: str, file: Path) -> None:
    try:
        save_png(graph, f"{name}, {graph.robots} robots", file)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise ScenarioError(f"--png is {file}; it must be a file that can be written ({reason}).") from None


def _print_list(console: Console, *, json: bool) -> None:
    if json:
        typer.echo(json_format.dumps({"topologies": {name: each.about for name, each in TOPOLOGIES.items()}}))
        return
    rows = Table.grid(padding=(0, 3))
    for name, each in TOPOLOGIES.items():
        rows.add_row(Text(name, "bold"), each.about)
    console.print(rows)
