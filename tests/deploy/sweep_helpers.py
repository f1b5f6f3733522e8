"""Sweeps for tests: runs of a tenth of a second, and the command as a real process."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pyarrow.parquet as pq
import typer
from typer.testing import CliRunner, Result

from deploy.cli.sweep import sweep
from deploy.sweep.execute import Report
from deploy.sweep.plan import Plan, make_plan
from deploy.sweep.spec import read_spec

DEADLINE = 60.0
SWEEP = [sys.executable, "-m", "deploy.cli", "sweep"]
REPOSITORY = Path(__file__).parent.parent.parent

SHORT = """
robots = 2
topology = "line"
max_time = 1
start.y = -6.0
start.x = 60.0
plume.warm_up = 40
wind.nodes = 11
"""


def write_spec(folder: Path, text: str, name: str = "spec") -> Path:
    file = folder / f"{name}.toml"
    file.write_text(text)
    return file


def short_spec(folder: Path, seeds: int = 3, more: str = "", name: str = "spec") -> Path:
    """Two cells of `seeds` runs, which take next to no time."""
    grid = 'grid.algorithm = ["cfpso", "dcs"]\n'
    return write_spec(folder, f"seeds = {{first = 7, count = {seeds}}}\n{grid}{SHORT}{more}", name)


def plan_of(file: Path) -> Plan:
    return make_plan(read_spec(file))


def start_sweep(*arguments: object, **options) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [*SWEEP, *map(str, arguments)],
        cwd=REPOSITORY,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **options,
    )


def command(*arguments: object) -> Result:
    """The command in this process; its workers are processes all the same."""
    app = typer.Typer()
    app.command()(sweep)
    before = signal.getsignal(signal.SIGTERM)
    try:
        return CliRunner().invoke(app, [str(each) for each in arguments])
    finally:
        signal.signal(signal.SIGTERM, before)


class Quiet:
    """A watcher that keeps what it is told."""

    def begin(self, report: Report, workers: int) -> None:
        self.workers = workers

    def update(self, report: Report) -> None:
        self.report = report


def rows_of(file: Path) -> list[dict[str, object]]:
    with file.open("rb") as source:
        return pq.read_table(source).to_pylist()


def wait_for(condition: Callable[[], bool], what: str, deadline: float = DEADLINE) -> None:
    end = time.monotonic() + deadline
    pause = threading.Event()
    while not condition():
        assert time.monotonic() < end, f"not within {deadline} s: {what}"
        pause.wait(0.01)
