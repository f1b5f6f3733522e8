"""Random fault schedules: does every run end with an outcome, the same twice, with its promises kept, leaving nobody?

    python tests/benchmarks/bench_faults.py --memory 1000 --processes 100 --out faults.jsonl
    python tests/benchmarks/bench_faults.py --only 137 --in memory     # one that failed, again
    python tests/benchmarks/bench_faults.py --toml 137                 # its scenario, as a file for `odourswarm run`

In memory every schedule is run twice, once of these with every message through the codec; over real processes once, against
a run in memory; in some of these the world is killed (SIGKILL) and comes back from its checkpoint, or a robot is killed
that no fault kills, and is started again (such a run is another one than in memory). The checkers go over all histories.
Every result is a line of --out as soon as it is there; what succeeded there already is not run again. The command that
repeats a failure is listed at the end; exit status 1 when there is one.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
import threading
import time
from collections import Counter, deque
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import msgspec

from deploy.faults.random_schedule import random_scenario
from deploy.faults.trial import Trial, Where, try_schedule
from protocol.scenario.dump import dump_toml

Task = tuple[int, Where]
DEADLINES: dict[Where, float] = {"memory": 300.0, "processes": 300.0}  # wall-clock s; the slowest take a tenth of it


def run_all(tasks: list[Task], jobs: int, max_time: float) -> Iterator[Trial]:
    """The trials as they end. A worker process that dies takes with it what it had: that is tried again, each alone."""
    queue, lost = deque(tasks), deque[Task]()
    context = multiprocessing.get_context("spawn")
    while queue or lost:
        alone = bool(lost)
        todo = deque((lost.popleft(),)) if alone else queue
        pending: dict[Future[Trial], Task] = {}
        with ProcessPoolExecutor(1 if alone else jobs, mp_context=context, initializer=end_with_parent) as pool:
            broken = False
            while pending or (todo and not broken):
                while todo and len(pending) < jobs and not broken:
                    task = todo.popleft()
                    try:
                        pending[pool.submit(try_schedule, *task, max_time, DEADLINES[task[1]])] = task
                    except BrokenProcessPool:
                        todo.appendleft(task)
                        broken = True
                for future in wait(pending, return_when=FIRST_COMPLETED).done:
                    task = pending.pop(future)
                    try:
                        yield future.result()
                    except BrokenProcessPool:
                        broken = True
                        if alone:
                            yield Trial(*task, max_time, "", (), "", ("the process that ran it died",))
                        else:
                            lost.append(task)


def end_with_parent() -> None:
    """A worker whose parent is killed ends, too, and with it the swarm that it has."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=lambda: (parent.join(), os._exit(1)), daemon=True).start()


def finished(out: Path | None, max_time: float) -> list[Trial]:
    """What stands in `out` and was a success; a failure is tried again, a line that was torn off is nothing."""
    if out is None or not out.exists():
        return []
    trials = []
    for line in out.read_bytes().splitlines():
        try:
            trials.append(msgspec.json.decode(line, type=Trial))
        except msgspec.MsgspecError:
            continue
    return [trial for trial in trials if trial.max_time == max_time and not trial.wrong]


def keep(out: Path, trial: Trial) -> None:
    """Put a line into `out`, in one write; a newline before it ends what a kill tore off."""
    torn = out.exists() and not (b"\n" + out.read_bytes()).endswith(b"\n")
    with out.open("ab", buffering=0) as file:
        file.write((b"\n" if torn else b"") + msgspec.json.encode(trial) + b"\n")


def command(trial: Trial) -> str:
    return f"python tests/benchmarks/bench_faults.py --only {trial.number} --in {trial.where} --max-time {trial.max_time:g}"


def report(trials: list[Trial], wall_s: float) -> None:
    kinds = Counter(kind for trial in trials for kind in trial.faults)
    laws = Counter(trial.about.split(",")[0] for trial in trials)
    print("kinds:", ", ".join(f"{kind} {count}" for kind, count in sorted(kinds.items())))
    print("algorithms:", ", ".join(f"{law} {count}" for law, count in sorted(laws.items())))
    for where in ("memory", "processes"):
        of = [trial for trial in trials if trial.where == where]
        if of:
            ends = Counter(trial.ended or "without an outcome" for trial in of)
            worlds, robots = sum(trial.killed == "world" for trial in of), sum("robot" in trial.killed for trial in of)
            said = f", the world killed in {worlds} and a robot in {robots}" if worlds or robots else ""
            print(f"{where}: {len(of)} schedules{said}, {sum(bool(trial.wrong) for trial in of)} failed; ended {dict(ends)}")
    orphans = sum(words.startswith("left behind") for trial in trials for words in trial.wrong)
    print(f"{orphans} orphans; {wall_s:.0f} s")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--memory", type=int, default=1000, metavar="N", help="how many in memory")
    parser.add_argument("--processes", type=int, default=100, metavar="N", help="how many over processes")
    parser.add_argument("--from", dest="first", type=int, default=0, metavar="K", help="number of the first schedule")
    parser.add_argument("--only", type=int, nargs="+", metavar="K", help="these schedules and no others")
    parser.add_argument("--in", dest="where", choices=["memory", "processes"], help="only there")
    parser.add_argument("--max-time", type=float, default=8.0, help="simulated s of a run")
    parser.add_argument("--jobs", type=int, default=1, help="how many at once in memory; over processes it is one at a time")
    parser.add_argument("--out", type=Path, metavar="FILE.jsonl", help="a line for every result")
    parser.add_argument("--toml", type=int, metavar="K", help="print the scenario of a schedule, and nothing else")
    given = parser.parse_args()
    if given.toml is not None:
        print(dump_toml(random_scenario(given.toml, given.max_time)), end="")
        return
    numbers: dict[Where, list[int]] = {
        "memory": given.only or list(range(given.first, given.first + given.memory)),
        "processes": given.only or list(range(given.first, given.first + given.processes)),
    }
    trials = finished(given.out, given.max_time)
    known = {(trial.number, trial.where) for trial in trials}
    trials = [trial for trial in trials if trial.number in numbers[trial.where] and given.where in (None, trial.where)]
    if trials:
        print(f"{len(trials)} stand in {given.out} already")
    began = time.perf_counter()
    for where, jobs in (("memory", given.jobs), ("processes", 1)):
        tasks: list[Task] = [(n, where) for n in numbers[where] if (n, where) not in known and given.where in (None, where)]
        for done, trial in enumerate(run_all(tasks, jobs, given.max_time), 1):
            trials.append(trial)
            if given.out is not None:
                keep(given.out, trial)
            if trial.wrong or where == "processes" or given.only or done % 50 == 0:
                verdict = "; ".join(trial.wrong) or trial.ended
                killed = f", {trial.killed} killed" if trial.killed else ""
                print(f"  {where} {trial.number} ({trial.about}{killed}, {trial.wall_s:.1f} s): {verdict}", flush=True)
    report(trials, time.perf_counter() - began)
    failures = [trial for trial in trials if trial.wrong]
    for trial in failures:
        print(f"FAILED: {'; '.join(trial.wrong)[:300]}\n    {command(trial)}")
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
