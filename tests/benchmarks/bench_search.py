"""How often and how fast the swarm finds the source, in memory.

    python tests/benchmarks/bench_search.py --algorithms cfpso dcs --cases 1 3 --topologies all ring line --seeds 50

prints one row a cell: found, median and mean time (failures counted at --max-time), smallest distance of two robots.
"""

from __future__ import annotations

import argparse
import itertools
import multiprocessing
import os
import statistics
import sys
import time

from deploy.memory_run import run_in_memory
from protocol.messages import Outcome
from protocol.scenario.load import load_scenario, parse_setting


def one(job: tuple[tuple[str, object, str], ...]) -> Outcome:
    """Run one seed of one cell."""
    return run_in_memory(load_scenario(None, overrides=job))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--algorithms", nargs="+", default=["cfpso", "dcs"])
    parser.add_argument("--cases", nargs="+", type=int, default=[1, 3])
    parser.add_argument("--topologies", nargs="+", default=["all", "ring", "line"])
    parser.add_argument("--robots", nargs="+", type=int, default=[5])
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--first-seed", type=int, default=1000)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--show-failures", action="store_true")
    given = parser.parse_args()
    settings = [(path, value, f"--set {path}") for path, value in map(parse_setting, given.set)]
    cells = list(itertools.product(given.algorithms, given.cases, given.topologies, given.robots))
    print("algorithm  case topology  N   found  median    mean    first  min pair  error   x real time")
    with multiprocessing.get_context("spawn").Pool(os.cpu_count()) as pool:
        for algorithm, case, topology, robots in cells:
            jobs = [
                (
                    ("case", case, "--case"),
                    ("algorithm", algorithm, "--algorithm"),
                    ("topology", topology, "--topology"),
                    ("robots", robots, "--robots"),
                    ("seed", given.first_seed + s, "--seed"),
                    *settings,
                )
                for s in range(given.seeds)
            ]
            began = time.perf_counter()
            outcomes = pool.map(one, jobs, chunksize=1)
            wall = time.perf_counter() - began
            times = [o.time for o in outcomes]
            firsts = [o.first_detection for o in outcomes if o.first_detection is not None]
            errors = [min(e for e in o.estimate_error if e is not None) for o in outcomes if any(o.estimate_error)]
            print(
                f"{algorithm:9}  {case:4} {topology:8} {robots:2}  {sum(o.found for o in outcomes):3}/{len(outcomes)}"
                f"  {statistics.median(times):6.1f}  {statistics.mean(times):6.1f}"
                f"   {statistics.median(firsts) if firsts else float('nan'):6.1f}"
                f"  {min(o.min_pair_distance or 0.0 for o in outcomes):8.2f}"
                f"  {statistics.median(errors) if errors else float('nan'):5.1f}"
                f"  {sum(times) / wall:8.0f}"
            )
            if given.show_failures:
                print("   not found:", [o.seed for o in outcomes if not o.found])
            sys.stdout.flush()


if __name__ == "__main__":
    main()
