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

COMMON = [
    [],
    ["sensors.wind_history=0"],
    ["decision.gate=printed"],
    ["decision.gate=estimate"],
    ["decision.noise=printed"],
    ["decision.process_noise=0"],
    ["fusion.input=always"],
    ["fusion.step=explicit"],
    ["planning.slope=printed"],
    ["planning.slope_limit=0"],
    ["control.step=explicit"],
    ["plume.growth=printed"],
    ["plume.growth=farrell2"],
    ["plume.warm_up=0", "sensors.wind_history=0"],
]
CASES: list[tuple[str, list[str]]] = [
    *(("cfpso", settings) for settings in COMMON),
    ("cfpso", ["cfpso.repulsion=false"]),
    ("dcs", []),
    ("dcs", ["dcs.repulsion=false"]),
    ("dcs", ["dcs.order=algorithm-2"]),
    ("dcs", ["dcs.turn=0.1"]),
    ("dcs", ["robots=7"]),
    ("dcs", ["robots=7", "dcs.sectors=5"]),
    ("dcs", ["decision.gate=printed", "decision.process_noise=0"]),
    ("simple", []),
    ("simple", ["repulsion.form=switch"]),
    ("cfpso", ["preset=literal"]),
    ("dcs", ["preset=literal"]),
    ("simple", ["preset=literal"]),
]


def one(job: tuple[str, list[str], int]) -> Outcome:
    algorithm, settings, seed = job
    overrides = [("algorithm", algorithm, "bench"), ("topology", "all", "bench"), ("case", 1, "bench")]
    overrides += [("seed", seed, "bench"), *((*parse_setting(text), "bench") for text in settings)]
    return run_in_memory(load_scenario(None, overrides=overrides))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=50)
    given = parser.parse_args()
    with multiprocessing.get_context("spawn").Pool(os.cpu_count()) as pool:
        for algorithm, settings in CASES:
            outcomes = pool.map(one, [(algorithm, settings, 1000 + s) for s in range(given.seeds)], chunksize=1)
            found = sum(o.found for o in outcomes)
            mean = statistics.mean(o.time if o.found else 1000.0 for o in outcomes)
            nearest = min(o.min_pair_distance or 0.0 for o in outcomes)
            name = " ".join(f"`{text}`" for text in settings) or "corrected"
            print(f"| `{algorithm}` | {name} | {found}/{len(outcomes)} | {mean:.0f} s | {nearest:.2f} m |", flush=True)


if __name__ == "__main__":
    main()
