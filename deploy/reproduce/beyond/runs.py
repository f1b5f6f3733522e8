"""The runs of the study "beyond": those of a sweep that was made, or a few of them, made now.

Rules: a run that is made here is one of the study's own and is kept with its results, so that a sweep later goes on from it.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from deploy.reproduce.kinds import Options
from deploy.sweep.execute import Report, default_jobs, execute
from deploy.sweep.plan import Plan, make_plan
from deploy.sweep.rows import Row
from deploy.sweep.store import finished
from deploy.sweep.studies import find_spec
from protocol.errors import ScenarioError, SwarmFailure

STUDY = "beyond"
RESULT = Path("results") / f"{STUDY}.parquet"
FEW = 2  # plumes of every gain, when there is no result


def get_rows(options: Options) -> list[Row]:
    """The finished runs: of `options.result`, or made now, `options.seeds` plumes of every gain.

    Raises:
        ScenarioError: the result is none, or has no such runs.
        SwarmFailure: a run failed.
    """
    file = options.result or RESULT
    if options.seeds is None and (rows := list(finished(file, aside=True).values())):
        for name in ("wind.gain", "case", "seed"):
            if name not in rows[0]:
                raise ScenarioError(f'{file} has no column "{name}"; give the result of `odourswarm sweep {STUDY}`.')
        return rows
    if options.result is not None and options.seeds is None:
        raise ScenarioError(f"{file}: there are no finished runs; `odourswarm sweep {STUDY} --out {file}` makes them.")
    plan = few_of(make_plan(find_spec(STUDY)), options.seeds or FEW)
    report = execute(plan, file, default_jobs(), _Nobody())
    if report.failed:
        job, why = report.failed[0]
        raise SwarmFailure(f"a run failed ({job.words}): {why}")
    return report.rows


def few_of(plan: Plan, plumes: int) -> Plan:
    """Of every gain and algorithm the first `plumes` runs: a new seed each, and the cases in turn."""
    cases = sorted({job.scenario.case for job in plan.jobs})
    first = plan.spec.first_seed
    wanted = {(cases[k % len(cases)], first + k) for k in range(min(plumes, plan.spec.seeds))}
    return replace(plan, jobs=tuple(job for job in plan.jobs if (job.scenario.case, job.scenario.seed) in wanted))


class _Nobody:
    """Nobody watches."""

    def begin(self, report: Report, workers: int) -> None:
        """Not shown."""

    def update(self, report: Report) -> None:
        """Not shown."""
