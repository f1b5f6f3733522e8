"""`odourswarm algorithms`: what `--algorithm` may be."""

from __future__ import annotations

from typing import Annotated

import typer
from typer import Option

from robot_agent.algorithms import ALGORITHMS


def algorithms(json: Annotated[bool, Option("--json", help="One JSON object on stdout.")] = False) -> None:
    """List the algorithms, each with what it is made of."""
    if json:
        import msgspec

        listing = {
            name: {"title": each.title, "exercise": each.drill, "begins": "at once" if each.at_once else "at a detection"}
            for name, each in ALGORITHMS.items()
        }
        typer.echo(msgspec.json.encode(listing).decode())
        return
    from rich.console import Console
    from rich.table import Table

    table = Table("name", "what", box=None)
    for name, each in ALGORITHMS.items():
        table.add_row(name, each.title)
    Console().print(table)
