"""`odourswarm reproduce`: a worked example of the thesis, theirs beside ours."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Argument, Option

from deploy.cli.options import INTERRUPTED, complain
from protocol.errors import ScenarioError, SwarmFailure
from protocol.shell import EXIT_BAD_INPUT, EXIT_FAILED, EXIT_OK

if TYPE_CHECKING:
    from collections.abc import Iterable

    from deploy.reproduce.kinds import Options, Reproduction, Result, Row

STYLES = {"agrees": "green", "differs": "red", "ours": "dim"}


def reproduce(
    name: Annotated[str | None, Argument(metavar="[NAME]", help="Which one; none: the list; all: every one.")] = None,
    out: Annotated[Path, Option("--out", help="Folder for the picture and the numbers.")] = Path("reproduction"),
    bus: Annotated[str, Option("--bus", help="Of those that run the swarm. zenoh: a process each; memory.")] = "zenoh",
    seed: Annotated[int, Option("--seed", help="All randomness follows from it.", min=0)] = 0,
    seeds: Annotated[
        int | None, Option("--seeds", min=1, help="beyond: make so many plumes of every gain now, not a sweep's result.")
    ] = None,
    result: Annotated[Path | None, Option("--result", metavar="FILE", help="beyond: a sweep's result.")] = None,
    json: Annotated[bool, Option("--json", help="One JSON object a line on stdout and nothing else.")] = False,
) -> None:
    """Run a worked example of the thesis again: its picture, and its numbers beside the thesis's text."""
    from deploy.reproduce.kinds import Options
    from deploy.reproduce.registry import ALL, find
    from deploy.reproduce.write import prepare

    try:
        if bus not in ("zenoh", "memory"):
            raise ScenarioError(f'--bus is "{bus}"; it must be zenoh or memory.')
        if name is None:
            _list(ALL.values(), json=json)
            return
        chosen = list(ALL.values()) if name == "all" else [find(name)]
        prepare(out)  # before the work, which may take minutes
    except ScenarioError as error:
        complain(error)
        raise typer.Exit(EXIT_BAD_INPUT) from None
    try:
        # One that cannot be made (a library is missing) does not keep the others from being made.
        status = max(_one(each, Options(bus, seed, seeds, result), out, json=json) for each in chosen)
    except KeyboardInterrupt:
        complain("interrupted; what was finished is written.")
        raise typer.Exit(INTERRUPTED) from None
    raise typer.Exit(status)


def _one(reproduction: Reproduction, options: Options, out: Path, *, json: bool) -> int:
    """Make, write and show one; the exit status."""
    from deploy.reproduce.write import write

    try:
        result = reproduction.make(options)
        files = write(reproduction, result, out)
    except ScenarioError as error:
        complain(f"{reproduction.name}: {error}")
        return EXIT_BAD_INPUT
    except SwarmFailure as error:
        complain(f"{reproduction.name}: {error}")
        return EXIT_FAILED
    if json:
        import msgspec

        typer.echo(msgspec.json.format(files[-1].read_bytes(), indent=-1).decode())
    else:
        _show(reproduction, result, files)
    return EXIT_OK


def _list(reproductions: Iterable[Reproduction], *, json: bool) -> None:
    if json:
        import msgspec

        facts = [{"name": r.name, "title": r.title, "place": r.place, "swarm": r.swarm} for r in reproductions]
        typer.echo(msgspec.json.encode({"reproductions": facts}).decode())
        return
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table("name", "what", "thesis", box=None)
    for each in reproductions:
        table.add_row(Text(each.name, no_wrap=True), Text(each.title), Text(each.place))
    Console().print(table)


def _show(reproduction: Reproduction, result: Result, files: list[Path]) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console()
    console.print(Text(f"{reproduction.title} ({reproduction.place})", style="bold"))
    table = Table.grid(padding=(0, 1))
    table.add_column(min_width=8, justify="right", no_wrap=True)
    table.add_column()
    for row in result.rows:
        table.add_row(Text(row.verdict, style=STYLES.get(row.verdict, "")), Text(row.quantity, style="bold"))
        for label, words in _lines(row):
            table.add_row(Text(label, style="dim"), Text(words))
    console.print(table)
    for file in files:
        console.print(Text(str(file)), soft_wrap=True)


def _lines(row: Row) -> list[tuple[str, str]]:
    """What is said about a quantity, without what is not said."""
    lines = [("thesis", row.thesis), ("we", row.ours), ("", row.note)]
    return [(label, words) for label, words in lines if words]
