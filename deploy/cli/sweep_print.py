"""What `odourswarm sweep` prints on stdout: summaries, the list of studies, the object of `--json`."""

from __future__ import annotations

from collections.abc import Sequence

import typer
from rich.console import Console
from rich.table import Table

from deploy.sweep import tables
from deploy.sweep.execute import Report
from deploy.sweep.plan import Plan
from deploy.sweep.rows import Row
from deploy.sweep.studies import find_spec, names
from deploy.sweep.summary import summarise

UNBOUNDED = 250  # columns of what is not a terminal
ROOMY = 110


def print_summary(rows: Sequence[Row], varied: Sequence[str], form: str) -> None:
    """One row per cell, as a table, CSV or Markdown."""
    cells = summarise(rows, varied)
    if form != "table":
        typer.echo({"csv": tables.as_csv, "markdown": tables.as_markdown}[form](cells), nl=False)
        return
    console = _console()
    table = Table(box=None, padding=(0, 2 if console.width >= ROOMY else 1, 0, 0))
    values = list(cells[0].values) if cells else []
    for name in (*values, *tables.headings(cells)):
        table.add_column(name, justify="left" if name in values else "right")
    for row in tables.table(cells):
        table.add_row(*row)
    console.print(table)


def print_report(report: Report, plan: Plan) -> None:
    """The object of a sweep that is over."""
    print_object(
        {
            "out": str(report.out),
            "runs": report.runs,
            "finished": len(report.rows),
            "reused": report.reused,
            "ran": report.ran,
            "ignored": report.ignored,
            "workers_lost": report.lost,
            "failed": [{"run": job.words, "scenario_digest": job.digest, "why": why} for job, why in report.failed],
            "wall_s": report.wall_s,
            "cells": tables.objects(summarise(report.rows, plan.varied)),
        }
    )


def print_cells(out: str, rows: Sequence[Row], varied: Sequence[str], missing: int | None) -> None:
    """The object of `--summary`; `missing` is None when there is no spec to say how many runs there should be."""
    cells = tables.objects(summarise(rows, varied))
    print_object({"out": out, "finished": len(rows), "missing": missing, "cells": cells})


def print_object(record: dict[str, object]) -> None:
    """One JSON object on one line."""
    import msgspec

    typer.echo(msgspec.json.encode(record).decode())


def print_studies(*, json: bool) -> None:
    """The studies that come with odourswarm."""
    specs = [find_spec(name) for name in names()]
    if json:
        print_object({"studies": {spec.name: spec.title for spec in specs}})
        return
    table = Table("study", "what", "seeds", box=None)
    for spec in specs:
        table.add_row(spec.name, spec.title, str(spec.seeds))
    _console().print(table)


def _console() -> Console:
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=UNBOUNDED)
