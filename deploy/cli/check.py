"""`odourswarm check DIR`: did a run keep its promises?

Exit status 0: it did; 1: it did not, the first counter-example of each broken promise is told; 2: there is no history.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Argument, Option

from deploy.cli.options import complain
from protocol.errors import ScenarioError
from protocol.shell import EXIT_BAD_INPUT

if TYPE_CHECKING:
    from deploy.checkers.check import Finding

EXIT_BROKEN = 1


def check(
    folder: Annotated[Path, Argument(metavar="DIR", help="What `odourswarm run --history DIR` left.")],
    json: Annotated[bool, Option("--json", help="One JSON object on stdout and nothing else there.")] = False,
) -> None:
    """Look whether a run kept its promises; a broken one is told with its first counter-example (exit status 1)."""
    from deploy.checkers.check import check_run, read_folder

    try:
        findings = check_run(read_folder(folder))
    except ScenarioError as error:
        complain(error)
        raise typer.Exit(EXIT_BAD_INPUT) from None
    passed = all(finding.passed for finding in findings)
    if json:
        import msgspec

        typer.echo(msgspec.json.encode({"passed": passed, "findings": findings}).decode())
    else:
        _print(findings)
    raise typer.Exit(0 if passed else EXIT_BROKEN)


def _print(findings: list[Finding]) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table("promise", "", "facts", "checker", box=None, header_style="bold", pad_edge=False)
    for finding in findings:
        verdict = Text("skipped", "dim") if finding.skipped else Text("kept", "green")
        if not finding.passed:
            verdict = Text("BROKEN", "bold red")
        table.add_row(finding.promise, verdict, str(finding.facts), Text(finding.name, "dim"))
    console = Console(highlight=False, soft_wrap=True)
    console.print(table)
    for finding in findings:
        if (words := finding.counterexample or finding.skipped) is not None:
            console.print(Text(f"{finding.name}: {words}.", "" if finding.passed else "red"))
