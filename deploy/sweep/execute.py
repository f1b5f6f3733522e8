"""A sweep from its plan to its result.

Rules: what is finished is kept before anybody is told of it; whichever way it ends, the result's file has everything.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from deploy.sweep.lock import only_one
from deploy.sweep.plan import Job, Plan
from deploy.sweep.rows import Row, make_row
from deploy.sweep.store import Store, forget, parts_of
from deploy.sweep.workers import Workers
from protocol.errors import ScenarioError

PAUSE = 0.5  # s between two looks at the clock while no run ends


@dataclass(slots=True)
class Report:
    """What a sweep did."""

    out: Path
    runs: int  # of the plan
    reused: int = 0  # were finished before
    foreign: int = 0  # of these, by other code
    ignored: int = 0  # finished runs that the spec does not have
    ran: int = 0
    lost: int = 0  # worker processes that died
    wall_s: float = 0.0
    failed: list[tuple[Job, str]] = field(default_factory=list)
    rows: list[Row] = field(default_factory=list)  # all finished runs of the plan, in its order


class Watcher(Protocol):
    """Who is told while a sweep goes on."""

    def begin(self, report: Report, workers: int) -> None:
        """What is there already is known; the rest begins."""
        ...

    def update(self, report: Report) -> None:
        """A run has ended, or some time has passed."""
        ...


def default_jobs() -> int:
    """The processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def execute(
    plan: Plan, out: Path, jobs: int, watcher: Watcher, *, fresh: bool = False, check: bool = False
) -> Report:
    """Run what is not finished of `plan`; the report.

    Args:
        out: the result's file.
        jobs: how many worker processes.
        fresh: forget what is finished.
        check: look whether each run keeps its promises; what was finished without is run again.
    Raises:
        ScenarioError: `out` is not to be used.
        SwarmFailure: no worker can be started.
        KeyboardInterrupt: it was interrupted; what was finished is in `out`.
    """
    _check(out)
    with only_one(parts_of(out), out):
        if fresh:
            forget(out)
        store = Store(out, plan)
        done = {digest for digest, row in store.rows.items() if not check or row["kept"] is not None}
        report = Report(out, len(plan.jobs), reused=len(done), foreign=store.foreign, ignored=store.ignored)
        # Seed by seed through all cells: when it is interrupted every cell has as many, and the time left is well known.
        left = [job for job in plan.jobs if job.digest not in done]
        left.sort(key=lambda job: job.scenario.seed)
        began = time.monotonic()
        try:
            with Workers(min(jobs, len(left)), check=check) as workers:
                watcher.begin(report, min(jobs, len(left)))
                for result in workers.run(left, PAUSE):
                    if result is not None and result.outcome is not None:
                        store.add(make_row(result.job, result.outcome, result.broken))
                        report.ran += 1
                        report.rows.append(store.rows[result.job.digest])
                    elif result is not None:
                        report.failed.append((result.job, result.error))
                    report.lost = workers.lost
                    report.wall_s = time.monotonic() - began
                    watcher.update(report)
        finally:
            store.compact()
        report.rows = [store.rows[job.digest] for job in plan.jobs if job.digest in store.rows]
        return report


def _check(out: Path) -> None:
    if out.suffix != ".parquet":
        raise ScenarioError(f'--out is {out}; it must be a file that ends in ".parquet".')
    if out.is_dir():
        raise ScenarioError(f"--out is {out}; it must be a file and is a folder.")
