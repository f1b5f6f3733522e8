"""What every departure from the thesis is worth: each switch alone as printed, the rest corrected.

    python tests/benchmarks/bench_departures.py [--seeds 50]

prints the rows of the tables in docs/departures.md.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import statistics

from deploy.memory_run import run_in_memory
from protocol.messages import Outcome
from protocol.scenario.load import load_scenario, parse_setting

CASES: list[tuple[str, list[str]]] = [
    ("cfpso", []),
    ("cfpso", ["sensors.wind_history=0"]),
    ("cfpso", ["decision.gate=printed"]),
    ("cfpso", ["decision.gate=estimate"]),
    ("cfpso", ["cfpso.repulsion=false"]),
    ("dcs", []),
    ("dcs", ["dcs.repulsion=false"]),
    ("simple", []),
    ("cfpso", ["fusion.input=always"]),
    ("cfpso", ["decision.noise=printed"]),
    ("cfpso", ["preset=literal"]),
    ("dcs", ["dcs.order=algorithm-2"]),
    ("simple", ["repulsion.form=switch"]),
    ("cfpso", ["fusion.step=explicit"]),
    ("cfpso", ["control.step=explicit"]),
    ("cfpso", ["planning.slope=printed", "planning.slope_limit=0"]),
    ("cfpso", ["decision.process_noise=0"]),
    ("dcs", ["preset=literal"]),
    ("simple", ["preset=literal"]),
    ("cfpso", ["plume.warm_up=0", "sensors.wind_history=0"]),
    ("dcs", ["dcs.turn=0.1"]),
    ("cfpso", ["plume.growth=printed"]),
    ("dcs", ["robots=7"]),
    ("dcs", ["robots=7", "dcs.sectors=5"]),
]


MAX_TIME = 600.0  # simulated s; who has not found the source by then counts with it


def one(job: tuple[str, list[str], int]) -> Outcome:
    algorithm, settings, seed = job
    values: list[tuple[str, object]] = [
        ("algorithm", algorithm), ("topology", "all"), ("case", 1), ("max_time", MAX_TIME), ("seed", seed),
        *map(parse_setting, settings),
    ]  # fmt: skip
    overrides = [(path, value, "bench") for path, value in values]
    return run_in_memory(load_scenario(None, overrides=overrides))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--from", dest="first", type=int, default=0, help="number of the first row")
    given = parser.parse_args()
    with multiprocessing.get_context("spawn").Pool(os.cpu_count()) as pool:
        for algorithm, settings in CASES[given.first :]:
            outcomes = pool.map(one, [(algorithm, settings, 1000 + s) for s in range(given.seeds)], chunksize=1)
            found = sum(o.found for o in outcomes)
            mean = statistics.mean(o.time if o.found else MAX_TIME for o in outcomes)
            nearest = min(o.min_pair_distance or 0.0 for o in outcomes)
            name = " ".join(f"`{text}`" for text in settings) or "corrected"
            print(f"| `{algorithm}` | {name} | {found}/{len(outcomes)} | {mean:.0f} s | {nearest:.2f} m |", flush=True)


if __name__ == "__main__":
    main()
