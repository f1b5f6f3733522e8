"""Same scenario and seed over Zenoh and in memory: are the digests equal?

    python tests/benchmarks/bench_digests.py --seeds 20            every algorithm x topology, 3 and 5 robots, short
    python tests/benchmarks/bench_digests.py --seeds 1 --full      one full run each

A short run starts next to the plume and lasts 6 simulated seconds: search, detection and tracing are in it.
"""

from __future__ import annotations

import argparse
import itertools
import sys

from deploy.launch.swarm import SwarmRun
from deploy.memory_run import run_in_memory
from protocol.messages import Event, Progress
from protocol.scenario.load import load_scenario
from protocol.topology.named import TOPOLOGIES
from robot_agent.algorithms import ALGORITHMS

SHORT = {"start.x": 60.0, "start.y": -6.0, "plume.warm_up": 120.0, "max_time": 6.0}


class Silent:
    def progress(self, progress: Progress) -> None:
        """Nobody watches."""

    def event(self, event: Event) -> None:
        """Nobody listens."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--algorithms", nargs="+", default=list(ALGORITHMS))
    parser.add_argument("--robots", nargs="+", type=int, default=[3, 5])
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--full", action="store_true")
    parser.add_argument("--from", dest="first", type=int, default=0, help="number of the first row")
    given = parser.parse_args()
    unequal = rows = 0
    for algorithm, (name, topology), robots in itertools.product(given.algorithms, TOPOLOGIES.items(), given.robots):
        if topology.robots not in (None, robots) and not (topology.robots == 4 and robots == 5):
            continue
        rows += 1
        if rows <= given.first:
            continue
        count = topology.robots or robots
        equal = detected = 0
        for seed in range(given.seeds):
            values = {"algorithm": algorithm, "topology": name, "robots": count, "seed": seed}
            values |= {} if given.full else SHORT
            scenario = load_scenario(None, overrides=[(k, v, "bench") for k, v in values.items()])
            over_zenoh = SwarmRun("bench", scenario).execute(Silent())
            in_memory = run_in_memory(scenario)
            equal += over_zenoh.digest == in_memory.digest
            detected += in_memory.first_detection is not None
        unequal += given.seeds - equal
        row = f"{algorithm:8} {name:9} {count} robots: {equal}/{given.seeds} equal, {detected} with a detection"
        print(row, flush=True)
    sys.exit(unequal > 0)


if __name__ == "__main__":
    main()
