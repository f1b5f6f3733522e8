"""`odourswarm reproduce`: a worked example of the thesis, theirs beside ours."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Argument, Option

from deploy.cli.options import INTERRUPTED, complain
from protocol.errors import ScenarioError, SwarmFailure
from protocol.shell import EXIT_BAD_INPUT, EXIT_FAILED

if TYPE_CHECKING:
    from deploy.reproduce.kinds import Reproduction, Result


def reproduce(
    name: Annotated[str | None, Argument(metavar="[NAME]", help="Which one; none: the list; all: every one.")] = None,
    out: Annotated[Path, Option("--out", help="Folder for the picture and the numbers.")] = Path("reproduction"),
    bus: Annotated[str, Option("--bus", help="Of those that run the swarm. zenoh: a process each; memory.")] = "zenoh",
    seed: Annotated[int, Option("--seed", help="All randomness follows from it.", min=0)] = 0,
    json: Annotated[bool, Option("--json", help="One JSON object on stdout for each and nothing else.")] = False,
) -> None:
    """Run a worked example of the thesis again: its picture, and its numbers beside the thesis's text."""
    from deploy.reproduce.kinds import Options
    from deploy.reproduce.registry import ALL, find

    try:
        if bus not in ("zenoh", "memory"):
            raise ScenarioError(f'--bus is "{bus}"; it must be zenoh or memory.')
        if name is None:
            _list(list(ALL.values()))
            return
        chosen = list(ALL.values()) if name == "all" else [find(name)]
        for each in chosen:
            _one(each, each.make(Options(bus, seed)), out, json=json)
    except ScenarioError as error:
        complain(error)
        raise typer.Exit(EXIT_BAD_INPUT) from None
    except SwarmFailure as error:
        complain(error)
        raise typer.Exit(EXIT_FAILED) from None
    except KeyboardInterrupt:
        complain("interrupted; what was finished is written.")
        raise typer.Exit(INTERRUPTED) from None


def _list(reproductions: list[Reproduction]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table("name", "what", "thesis", box=None)
    for each in reproductions:
        table.add_row(each.name, each.title, each.place)
    Console().print(table)


def _one(reproduction: Reproduction, result: Result, out: Path, *, json: bool) -> None:
    from deploy.reproduce.write import write

    try:
        files = write(reproduction, result, out)
    except OSError as error:
        raise ScenarioError(f"--out is {out}; nothing can be written there: {error.strerror}.") from None
    if json:
        import msgspec

        typer.echo(msgspec.json.format(files[-1].read_bytes(), indent=-1).decode())
        return
    from rich.console import Console
    from rich.table import Table

    console = Console()
    console.print(f"[bold]{reproduction.title}[/bold] ({reproduction.place})")
    table = Table("quantity", "thesis", "ours", "", "note", box=None)
    for row in result.rows:
        table.add_row(row.quantity, row.thesis, row.ours, row.verdict, row.note)
    console.print(table)
    for file in files:
        console.print(f"  {file}")
