"""Random fault schedules: does every run end with an outcome, and twice with the same digest?

    python tests/benchmarks/bench_faults.py --memory 1000 --processes 100

In memory every schedule is run twice, in worker processes; over real processes once (a launcher each), against a run in
memory. The checkers (deploy.checkers) go over the history of each. After each run over processes nobody may be left. The
last line has the totals; exit status 1 when any failed.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import psutil

from deploy.checkers.check import History, read_folder, read_memory, unplanned
from deploy.faults.random_schedule import random_scenario
from deploy.launch.swarm import SwarmRun
from deploy.memory_run import run_in_memory
from protocol.errors import SwarmFailure
from protocol.history.file import HistoryMemory
from protocol.messages import Event, Progress

OURS = ("world_server", "robot_agent")


class Silent:
    def progress(self, progress: Progress) -> None:
        """Nobody watches."""

    def event(self, event: Event) -> None:
        """Nobody listens."""


def surprises(history: History) -> str:
    """The promises that the run broke, other than by a planned lie; empty: none."""
    return "; ".join(f"{finding.name}: {finding.counterexample}" for finding in unplanned(history))


def twice(number: int, max_time: float) -> tuple[int, str, bool, list[str], str]:
    """Number, how the run ended, whether both runs were the same, kinds of faults, broken promises."""
    scenario = random_scenario(number, max_time)
    histories = HistoryMemory()
    first, second = run_in_memory(scenario, history=histories), run_in_memory(scenario, wire=True)
    same = first.digest == second.digest and first.faults == second.faults
    return number, first.ended, same, kinds(number, max_time), surprises(read_memory(histories))


def kinds(number: int, max_time: float) -> list[str]:
    return [str(fault.__struct_config__.tag) for fault in random_scenario(number, max_time).faults]


def left_over() -> list[int]:
    children = psutil.Process().children(recursive=True)
    return [p.pid for p in children if p.is_running() and any(name in " ".join(p.cmdline()) for name in OURS)]


def over_processes(number: int, max_time: float) -> tuple[str, bool, str]:
    """How the run ended, whether it was the one in memory, broken promises."""
    scenario = random_scenario(number, max_time)
    with tempfile.TemporaryDirectory() as folder:
        try:
            outcome = SwarmRun(f"bench-{number}", scenario, history=Path(folder)).execute(Silent())
        except SwarmFailure as failure:
            return f"failed: {failure}", False, ""
        broken = surprises(read_folder(Path(folder)))
    expected = run_in_memory(scenario)
    return outcome.ended, outcome.digest == expected.digest and outcome.faults == expected.faults, broken


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--memory", type=int, default=1000)
    parser.add_argument("--processes", type=int, default=100)
    parser.add_argument("--max-time", type=float, default=8.0, help="simulated s of a run")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--from", dest="first", type=int, default=0, help="number of the first schedule")
    given = parser.parse_args()
    numbers = range(given.first, given.first + given.memory)
    ends: Counter[str] = Counter()
    used: Counter[str] = Counter()
    bad: list[str] = []
    began = time.perf_counter()
    with ProcessPoolExecutor(given.workers) as pool:
        for number, ended, same, faults, broken in pool.map(partial(twice, max_time=given.max_time), numbers, chunksize=4):
            ends[ended] += 1
            used.update(faults)
            if not same:
                bad.append(f"memory {number}: not the same twice")
            if broken:
                bad.append(f"memory {number}: {broken}")
    in_memory = time.perf_counter() - began
    orphans = 0
    real: Counter[str] = Counter()
    began = time.perf_counter()
    for number in range(given.first, given.first + given.processes):
        ended, same, broken = over_processes(number, given.max_time)
        real[ended] += 1
        if not same:
            bad.append(f"processes {number}: {ended}, not as in memory")
        if broken:
            bad.append(f"processes {number}: {broken}")
        orphans += len(left_over())
        print(f"  processes {number}: {ended}, {'equal' if same else 'DIFFERENT'}", flush=True)
    over_wires = time.perf_counter() - began
    for line in bad:
        print(line)
    print("kinds:", ", ".join(f"{kind} {count}" for kind, count in sorted(used.items())))
    print(
        f"memory: {given.memory} schedules twice in {in_memory:.0f} s, ended {dict(ends)}; "
        f"processes: {given.processes} in {over_wires:.0f} s, ended {dict(real)}; "
        f"{orphans} orphans, {len(bad)} failures"
    )
    sys.exit(bool(bad or orphans))


if __name__ == "__main__":
    main()
