"""What the real swarm of processes costs: ticks/s, start-up, memory, with and without a recorder.

    python tests/benchmarks/bench_swarm.py speed --robots 5 [--baseline "COMMAND"] [--record]
    python tests/benchmarks/bench_swarm.py start --robots 5
    python tests/benchmarks/bench_swarm.py memory --robots 5

`speed` alternates runs of the swarm on a line, control maths included, with the baseline command, which prints a JSON
line with `ticks_per_s` (a bare lock-step over the same middleware), and prints the ratios. The source is out of reach,
so that a run has as many ticks as asked for. `--record` alternates runs with and without a recorder instead.
"""

from __future__ import annotations

import argparse
import json
import shlex
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psutil

RUN = [sys.executable, "-m", "deploy.cli", "run", "--json", "--topology", "line"]


def swarm(robots: int, ticks: int, *more: str) -> dict[str, float]:
    """One run of `ticks` ticks."""
    command = [*RUN, "--robots", str(robots), "--max-time", str(ticks * 0.05), "--source", "1,49", *more]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    outcome: dict[str, float] = json.loads(done.stdout)
    return outcome


def speed(given: argparse.Namespace) -> None:
    rates: list[float] = []
    others: list[float] = []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(given.rounds):
            if given.record:
                more = ("--record", str(Path(folder) / "bench.rrd"))
                others.append(swarm(given.robots, given.ticks, "--algorithm", given.algorithm, *more)["ticks_per_s"])
            elif given.baseline:
                done = subprocess.run(shlex.split(given.baseline), capture_output=True, text=True, check=True)
                others.append(json.loads(done.stdout)["ticks_per_s"])
            rates.append(swarm(given.robots, given.ticks, "--algorithm", given.algorithm)["ticks_per_s"])
            print(f"  swarm {rates[-1]:7.1f} ticks/s" + (f", other {others[-1]:7.1f}" if others else ""), flush=True)
    print(f"{given.robots} robots, {given.algorithm}: median {statistics.median(rates):.1f} ticks/s")
    if others:
        ratios = [a / b for a, b in zip(rates, others, strict=True)]
        name = "without / with recorder" if given.record else "swarm / baseline"
        print(f"{name}: median {statistics.median(ratios):.2f} (of {', '.join(f'{r:.2f}' for r in ratios)})")


def start(given: argparse.Namespace) -> None:
    walls = []
    for _ in range(given.rounds):
        began = time.perf_counter()
        swarm(given.robots, 1)
        walls.append(time.perf_counter() - began)
    print(f"{given.robots} robots: from the command through its first and only tick to the end of all processes:")
    print(f"median {statistics.median(walls):.2f} s (of {', '.join(f'{w:.2f}' for w in walls)})")


def memory(given: argparse.Namespace) -> None:
    command = [*RUN, "--robots", str(given.robots), "--max-time", "2000", "--source", "1,49"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    try:
        time.sleep(given.seconds)
        sizes: dict[str, list[float]] = {}
        for child in psutil.Process(process.pid).children(recursive=True):
            words = child.cmdline()
            sizes.setdefault(words[words.index("-m") + 1], []).append(child.memory_info().rss / 2**20)
        for module, values in sizes.items():
            print(f"{module}: {len(values)} x {statistics.mean(values):.1f} MB, largest {max(values):.1f} MB")
    finally:
        process.terminate()
        process.wait()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["speed", "start", "memory"])
    parser.add_argument("--robots", type=int, default=5)
    parser.add_argument("--algorithm", default="cfpso")
    parser.add_argument("--ticks", type=int, default=2000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--baseline")
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--seconds", type=float, default=5.0)
    given = parser.parse_args()
    {"speed": speed, "start": start, "memory": memory}[given.what](given)


if __name__ == "__main__":
    main()
