"""`odourswarm sweep`: a grid of runs in memory on all cores, resumable, and what came out of it."""

from __future__ import annotations

import signal
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer
from typer import Argument, Option

from deploy.cli.options import INTERRUPTED, complain
from protocol.errors import ScenarioError, SwarmFailure
from protocol.shell import EXIT_BAD_INPUT, EXIT_FAILED

if TYPE_CHECKING:
    from deploy.sweep.plan import Plan

MOST_BROKEN = 5  # broken promises that are told one by one


def sweep(
    spec: Annotated[
        str | None, Argument(metavar="[SPEC.toml]", help="A sweep's file, or a study by name; none: the list of studies.")
    ] = None,
    jobs: Annotated[int | None, Option("--jobs", "-j", min=1, help="Worker processes; as many as processors.")] = None,
    out: Annotated[
        Path | None, Option("--out", metavar="FILE", help="The result; results/NAME.parquet when it is not given.")
    ] = None,
    summary: Annotated[bool, Option("--summary", help="Only say what came out; SPEC may be a result, too.")] = False,
    fresh: Annotated[bool, Option("--fresh", help="Forget the runs that are finished, and run all again.")] = False,
    check: Annotated[
        bool, Option("--check", help="Look whether each run keeps its promises, as `check` does; takes longer.")
    ] = False,
    plot: Annotated[
        Path | None, Option("--plot", metavar="FILE.png", help="Draw what came out, against what the study varies.")
    ] = None,
    form: Annotated[str, Option("--format", help="Of the summary: table, csv, markdown.")] = "table",
    json: Annotated[bool, Option("--json", help="One JSON object on stdout and nothing else there.")] = False,
) -> None:
    """Run a grid of scenarios; what is finished is kept, and the same command goes on where it was stopped."""
    from deploy.cli.sweep_print import print_studies

    try:
        _check(spec, form, plot, summary=summary, check=check)
        if spec is None:
            print_studies(json=json)
        elif summary:
            _summary(spec, out, form, plot, json=json)
        else:
            _sweep(spec, out, jobs, form, plot, fresh=fresh, check=check, json=json)
    except ScenarioError as error:
        complain(error)
        raise typer.Exit(EXIT_BAD_INPUT) from None
    except SwarmFailure as error:
        complain(error)
        raise typer.Exit(EXIT_FAILED) from None
    except OSError as error:
        complain(f"{error.filename or out}: {(error.strerror or str(error)).lower()}; what was finished is kept.")
        raise typer.Exit(EXIT_FAILED) from None


def _sweep(
    spec: str,
    out: Path | None,
    jobs: int | None,
    form: str,
    plot: Path | None,
    *,
    fresh: bool,
    check: bool,
    json: bool,
) -> None:
    from deploy.cli.sweep_print import print_report, print_summary
    from deploy.cli.sweep_progress import SweepDisplay
    from deploy.sweep.execute import default_jobs, execute
    from deploy.sweep.plot import draw, no_axis

    plan, file = _plan(spec, out)
    if plot is not None and not any(job.plot for job in plan.jobs):
        raise ScenarioError(no_axis(plan.spec.file))
    signal.signal(signal.SIGTERM, _terminate)
    try:
        with SweepDisplay(plan.spec.name) as display:
            report = execute(plan, file, jobs or default_jobs(), display, fresh=fresh, check=check)
    except KeyboardInterrupt:
        complain(f"interrupted; {file} has what was finished, the same command goes on from there.")
        raise typer.Exit(INTERRUPTED) from None
    if json:
        print_report(report, plan)
    elif report.rows:
        print_summary(report.rows, plan.varied, form)
    if plot is not None and report.rows:
        draw(report.rows, plan.varied, plan.spec.title, plot)
    complain(f"{file} has {len(report.rows)} of {report.runs} runs.")
    broken = [row for row in report.rows if row["kept"] is False]
    for row in broken[:MOST_BROKEN]:
        complain(f"a promise was broken: {row['broken']} ({row['label']}, seed {row['seed']}, {row['scenario_digest']}).")
    if len(broken) > MOST_BROKEN:
        complain(f"and {len(broken) - MOST_BROKEN} runs more; the columns kept and broken of {file} have all of them.")
    if report.failed:
        complain(f"{len(report.failed)} runs failed; the same command tries them again.")
        raise typer.Exit(EXIT_FAILED)


def _summary(spec: str, out: Path | None, form: str, plot: Path | None, *, json: bool) -> None:
    from deploy.cli.sweep_print import print_cells, print_summary
    from deploy.sweep.plot import draw, no_axis
    from deploy.sweep.rows import relabel
    from deploy.sweep.store import finished, grid_of

    missing, title = None, ""
    if spec.endswith(".parquet"):
        file = Path(spec)
        rows = list(finished(file).values())
        varied = grid_of(file, rows)
    else:
        plan, file = _plan(spec, out)
        found = finished(file, aside=True)
        rows = [relabel(job, found[job.digest]) for job in plan.jobs if job.digest in found]
        varied, missing, title = plan.varied, len(plan.jobs) - len(rows), plan.spec.title
    if not rows:
        raise ScenarioError(f"{file}: there are no finished runs; `odourswarm sweep SPEC.toml` makes them.")
    if plot is not None:
        if not any(row.get("plot") for row in rows):
            raise ScenarioError(no_axis(spec))
        draw(rows, varied, title, plot)
    if json:
        print_cells(str(file), rows, varied, missing)
        return
    print_summary(rows, varied, form)
    if missing:
        complain(f"{missing} runs are missing; `odourswarm sweep {spec}` makes them.")


def _plan(spec: str, out: Path | None) -> tuple[Plan, Path]:
    from deploy.sweep.plan import make_plan
    from deploy.sweep.studies import find_spec

    plan = make_plan(find_spec(spec))
    return plan, out or Path("results") / f"{plan.spec.name}.parquet"


def _check(spec: str | None, form: str, plot: Path | None, *, summary: bool, check: bool) -> None:
    from deploy.sweep.tables import FORMATS

    if plot is not None and (spec is None or plot.suffix not in (".png", ".svg", ".pdf") or not plot.parent.is_dir()):
        sentence = "it needs a study or a sweep's file, and a file that ends in .png, .svg or .pdf in a folder that exists"
        raise ScenarioError(f"--plot is {plot}; {sentence}.")

    if form not in FORMATS:
        raise ScenarioError(f'--format is "{form}"; it must be table, csv or markdown.')
    if check and (summary or spec is None):
        raise ScenarioError("--check looks at runs while they are made; give it with a sweep's file, and without --summary.")
    if spec is None and summary:
        raise ScenarioError("--summary: give the result of a sweep, its spec, or a study by name.")


def _terminate(signum: int, frame: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt
