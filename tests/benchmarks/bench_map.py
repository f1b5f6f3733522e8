"""What the map of one robot costs when it has the processor's caches to itself: events drawn, mean and covariance.

    python tests/benchmarks/bench_map.py [--gains 0.15 2] [--seeds 5 6 7]

`bench_decision.py time` plays five robots and the world in one process, where each finds the caches full of the others'
maps. Here the events of a robot are recorded in such a run and drawn again, second by second, on a map that is alone in
its process. Flood and plan, some 0.1 ms, are not in it. The yardstick is timed between the seconds: it, too, is alone.
"""

from __future__ import annotations

import argparse
import gc
import statistics
import time
from itertools import groupby
from typing import Any

from bench_decision import play, scenario, yardstick

from deploy.memory_run import MemorySwarm
from protocol.scenario import Scenario
from robot_agent.plume.events import Event
from robot_agent.plume.map import EventMap
from robot_agent.plume.posterior import posterior


def record(chosen: Scenario) -> list[tuple[int, int, Event]]:
    """The second in which robot 0 drew each event, the event's decision, the event."""
    swarm = MemorySwarm(chosen)
    chart = swarm.robots[0].session.agent._decision.chart
    drawn: list[tuple[int, int, Event]] = []
    plain = chart.learn

    def learn(k: int, event: Event) -> None:
        drawn.append((int(swarm.session.world.t), k, event))
        plain(k, event)

    chart.learn = learn
    play(swarm, lambda: None)
    return drawn


def draw(chosen: Scenario, drawn: list[tuple[int, int, Event]]) -> tuple[list[float], list[float], list[float]]:
    """Milliseconds of every second: events, mean, yardstick."""
    chart = EventMap(chosen.arena, chosen.plume_map, chosen.timing.decision)
    events, means, sticks = [], [], []
    for _, second in groupby(drawn, key=lambda one: one[0]):
        began = time.thread_time_ns()
        for _, k, event in second:
            chart.learn(k, event)
        drew = time.thread_time_ns()
        posterior(chart)
        ended = time.thread_time_ns()
        events.append((drew - began) / 1e6)
        means.append((ended - drew) / 1e6)
        sticks.append(yardstick() / 1e6)
    return events, means, sticks


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--gains", nargs="+", type=float, default=[0.15, 2.0])
    parser.add_argument("--seeds", nargs="+", type=int, default=[5, 6, 7])
    given = parser.parse_args()
    print("processor time of a robot's map alone, a second of five robots' events, ms")
    print("gain  median    p95   yardstick  ratio   of it, medians")
    for gain in given.gains:
        all_events: list[float] = []
        all_means: list[float] = []
        all_sticks: list[float] = []
        for seed in given.seeds:
            values: dict[str, Any] = {"wind.gain": gain, "topology": "all", "seed": seed, "case": 1, "max_time": 200.0}
            chosen = scenario(values)
            drawn = record(chosen)
            gc.collect()
            events, means, sticks = draw(chosen, drawn)
            all_events += events
            all_means += means
            all_sticks += sticks
        totals = sorted(e + m for e, m in zip(all_events, all_means, strict=True))
        middle, stick = statistics.median(totals), statistics.median(all_sticks)
        print(
            f"{gain:4}  {middle:6.3f} {totals[round(0.95 * len(totals))]:6.3f}   {stick:9.3f}  {middle / stick:5.2f}"
            f"   events {statistics.median(all_events):.2f}, mean {statistics.median(all_means):.2f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
