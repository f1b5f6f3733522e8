"""What a person sees while a sweep goes on: a bar on a terminal, now and then a line anywhere else."""

from __future__ import annotations

import time
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn

from deploy.sweep.execute import Report

LINE_PERIOD = 30.0  # wall-clock s between two lines


class SweepDisplay:
    """Progress with the time left, on stderr."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._console = Console(stderr=True, highlight=False)
        self._bar: Progress | None = None
        self._task = TaskID(0)
        self._next_line = 0.0
        self._failed = 0  # of the failed runs, those that were looked at
        self._told: set[str] = set()

    def __enter__(self) -> SweepDisplay:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def begin(self, report: Report, workers: int) -> None:
        """What is there already is known; the rest begins."""
        left = report.runs - report.reused
        parts = [f"{report.runs} runs"]
        if report.reused:
            parts.append(f"{report.reused} finished before")
        if report.foreign:
            parts.append(f"{report.foreign} of these by another version, which --fresh would run again")
        if report.ignored:
            parts.append(f"{report.ignored} finished ones ignored that this spec does not have")
        parts.append(f"{left} to do with {workers} process{'es' if workers != 1 else ''}" if left else "nothing to do")
        self._console.print(f"[bold]{self._name}[/bold]: {', '.join(parts)}", soft_wrap=True)
        if left and self._console.is_terminal:
            self._bar = Progress(
                BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[more]}"), console=self._console, transient=True
            )
            self._task = self._bar.add_task("", total=left, more="")
            self._bar.start()
        self._next_line = time.monotonic() + LINE_PERIOD

    def update(self, report: Report) -> None:
        """A run has ended, or some time has passed."""
        for job, sentence in report.failed[self._failed :]:
            if sentence not in self._told:  # a fault in the code would say the same of every run
                self._told.add(sentence)
                self._console.print(f"failed: {job.words}: {sentence}", style="red", soft_wrap=True, markup=False)
        self._failed = len(report.failed)
        done = report.ran + len(report.failed)
        more = words(report)
        if self._bar is not None:
            self._bar.update(self._task, completed=done, more=more)
        elif time.monotonic() >= self._next_line:
            self._next_line = time.monotonic() + LINE_PERIOD
            self._console.print(f"{done}/{report.runs - report.reused} runs, {more}", soft_wrap=True)


def words(report: Report) -> str:
    """How it goes and the time left."""
    done = report.ran + len(report.failed)
    found = sum(row["found"] for row in report.rows)
    if not done:
        return "the first runs are on their way"
    left = report.wall_s / done * (report.runs - report.reused - done)
    failed = f", {len(report.failed)} failed" if report.failed else ""
    return f"{found} found{failed}, {duration(left)} left"


def duration(seconds: float) -> str:
    """A time span in words that are as exact as they need to be."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02} s"
    return f"{whole // 3600} h {whole % 3600 // 60:02} min"
