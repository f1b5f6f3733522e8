"""What a decision of `plume-map` costs a robot that has the processor's caches to itself, as in a process of its own.

    python tests/benchmarks/bench_alone.py [--gains 0.15 2] [--topologies all ring] [--seeds 5 6 7]

`bench_decision.py time` plays five robots and the world in one process, where each finds the caches full of the others'
maps. Here what robot 0 sensed and heard in such a run is recorded, and told to a second robot 0 tick by tick, with nothing
else to do in between but a yardstick every second. It must say and drive as the first one did.
"""

from __future__ import annotations

import argparse
import gc
import statistics
from typing import Any

from bench_decision import PARTS, Stopwatch, play, scenario, yardstick

from deploy.memory_run import MemorySwarm
from protocol.messages import Drive, Reading, Shared
from protocol.scenario import Scenario

Tick = tuple[Reading, list[Shared], Drive]


def record(chosen: Scenario) -> list[Tick]:
    """What robot 0 sensed and heard at each tick, and how it drove."""
    swarm = MemorySwarm(chosen)
    session: Any = swarm.robots[0].session
    readings: list[Reading] = []
    ticks: list[Tick] = []
    sense, act = session._sense, session.agent.act

    def sensing(reading: Reading) -> Shared:
        readings.append(reading)
        said: Shared = sense(reading)
        return said

    def acting(heard: Any) -> Drive:
        states = list(heard)
        drive: Drive = act(states)
        ticks.append((readings[-1], states, drive))
        return drive

    session._sense, session.agent.act = sensing, acting
    play(swarm, lambda: None)
    return ticks


def again(chosen: Scenario, ticks: list[Tick]) -> tuple[list[dict[str, int]], list[int]]:
    """Nanoseconds of the parts of every second, and the yardstick's."""
    agent = MemorySwarm(chosen).robots[0].session.agent
    watch, sticks = Stopwatch(agent), []
    per_second = round(1.0 / chosen.timing.tick)
    for n, (reading, heard, drive) in enumerate(ticks, 1):
        agent.sense(reading)
        if agent.act(heard) != drive:
            raise RuntimeError(f"tick {reading.tick}: not the drive that was recorded")
        if n % per_second == 0:
            watch.turn()
            sticks.append(yardstick())
    return watch.seconds[1:], sticks


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--gains", nargs="+", type=float, default=[0.15, 2.0])
    parser.add_argument("--topologies", nargs="+", default=["all", "ring"])
    parser.add_argument("--seeds", nargs="+", type=int, default=[5, 6, 7])
    given = parser.parse_args()
    print("processor time of a decision of a robot alone in its process, a second of five robots' events, ms")
    print("gain  graph          median    p95   yardstick  ratio p95   of it, medians")
    for gain in given.gains:
        for graph in given.topologies:
            seconds: list[dict[str, int]] = []
            sticks: list[int] = []
            for seed in given.seeds:
                values: dict[str, Any] = {"wind.gain": gain, "topology": graph, "seed": seed, "case": 1, "max_time": 200.0}
                chosen = scenario(values)
                ticks = record(chosen)
                gc.collect()
                parts, yards = again(chosen, ticks)
                seconds += parts
                sticks += yards
            totals = sorted(sum(second.values()) / 1e6 for second in seconds)
            middle, p95 = statistics.median(totals), totals[round(0.95 * len(totals))]
            stick = statistics.median(sticks) / 1e6
            of_it = ", ".join(f"{part} {statistics.median(s[part] for s in seconds) / 1e6:.2f}" for part in PARTS)
            print(
                f"{gain:4}  {graph:13} {middle:7.3f} {p95:6.3f}   {stick:9.3f}"
                f"  {middle / stick:5.2f} {p95 / stick:4.2f}   {of_it}",
                flush=True,
            )


if __name__ == "__main__":
    main()
