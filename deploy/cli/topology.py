"""`odourswarm topology NAME|SCENARIO.toml`: the graph, drawn, with what its Laplacian says, stage by stage if it changes.

Rules: the graph comes from the code that the swarm uses, so that what is drawn is what will be linked.
"""

from __future__ import annotations

import json as json_format
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import msgspec
import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from deploy.cli.graph_png import save_png, save_stages_png
from deploy.cli.graph_report import facts, print_report
from deploy.cli.graph_stages import stages_of
from deploy.cli.options import read_scenario
from deploy.cli.stages_report import print_stages, stages_facts
from protocol.errors import ScenarioError
from protocol.scenario.resolve import resolve
from protocol.scenario.scenario import Scenario
from protocol.scenario.settings import read_settings
from protocol.scenario.toml_file import read_toml
from protocol.topology.analysis import analyse, gain_condition
from protocol.topology.graph import Graph
from protocol.topology.named import TOPOLOGIES


def topology(
    name: Annotated[
        str | None, typer.Argument(help="A topology, a graph file, or a scenario file; none: the list.")
    ] = None,
    robots: Annotated[int | None, typer.Option("--robots", "-n", help="Number of robots N.")] = None,
    beta: Annotated[float | None, typer.Option("--beta", help="Position gain for condition (5.2).")] = None,
    gamma: Annotated[float | None, typer.Option("--gamma", help="Velocity gain for condition (5.2).")] = None,
    setting: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="For example graph_options.mean_degree=3.")
    ] = None,
    follow: Annotated[
        bool, typer.Option("--follow", help="Of a graph that changes: run the scenario in memory and follow it.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="One JSON object and nothing else.")] = False,
    png: Annotated[Path | None, typer.Option("--png", help="Draw the graph into an image file, too.")] = None,
) -> None:
    """Draw a communication graph; print its Laplacian's eigenvalues and whether the gains fit it."""
    console = Console(highlight=False)
    try:
        if name is None:
            _print_list(console, json=json)
            return
        scenario = _scenario(name, robots, setting or [])
        gains = (_gain("beta", beta, scenario.dcs.beta), _gain("gamma", gamma, scenario.dcs.gamma))
        if follow and not scenario.schedule:
            raise ScenarioError(f"--follow is for a graph that changes, and {scenario.topology} never does; leave it out.")
        report = _report_stages if scenario.schedule else _report_graph
        report(console, name, scenario, gains, png, follow=follow, json=json)
    except ScenarioError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(2) from None


def _report_graph(
    console: Console, name: str, scenario: Scenario, gains: tuple[float, float], png: Path | None, *,
    follow: bool, json: bool,
) -> None:  # fmt: skip
    graph = Graph(scenario.robots, scenario.graph)
    analysis = analyse(graph)
    condition = gain_condition(analysis, *gains)
    if png is not None:
        _save(lambda: save_png(graph, f"{scenario.topology}, {graph.robots} robots", png), png)
    if json:
        typer.echo(json_format.dumps(facts(name, graph, analysis, condition), allow_nan=False))
    else:
        print_report(console, scenario.topology, graph, analysis, condition)


def _report_stages(
    console: Console, name: str, scenario: Scenario, gains: tuple[float, float], png: Path | None, *,
    follow: bool, json: bool,
) -> None:  # fmt: skip
    stages = stages_of(scenario, follow=follow)
    if png is not None:
        _save(lambda: save_stages_png(stages, f"{scenario.topology}, {scenario.robots} robots", png), png)
    if json:
        typer.echo(json_format.dumps(stages_facts(name, stages, gains), allow_nan=False))
    else:
        print_stages(console, scenario.topology, stages, gains)


def _scenario(name: str, robots: int | None, settings: list[str]) -> Scenario:
    """The scenario in the file `name`, or the default one on the topology `name`."""
    if _is_scenario(Path(name)):
        return read_scenario(Path(name), settings, robots=robots)
    base = read_scenario(None, settings, robots=robots)
    base = msgspec.structs.replace(base, topology=name, graph=(), schedule=())
    return resolve(base, robots_given=robots is not None, origins={"robots": "--robots"})


def _is_scenario(file: Path) -> bool:
    """Whether this is a TOML file that holds no graph: both end in .toml, only a graph has edges."""
    return file.suffix == ".toml" and file.is_file() and "edges" not in read_toml(file)


def _gain(name: str, value: float | None, default: float) -> float:
    if value is None:
        return default
    (setting,) = read_settings(("dcs", name), value, f"--{name}")
    assert isinstance(setting.value, float)
    return setting.value


def _save(save: Callable[[], None], file: Path) -> None:
    try:
        save()
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
