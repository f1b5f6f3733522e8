"""What a step of the world's physics costs, in microseconds: python tests/benchmarks/bench_world.py

Best of several repeats, so that what else the machine does is left out. The thesis's figures: 5 robots, wind 1 m/s,
some 940 filaments.
"""

from __future__ import annotations

import sys
import time
import timeit
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import numpy as np

from protocol.scenario import Scenario
from world_server.bodies import Bodies
from world_server.field import Field
from world_server.noise import StepNoise, generator_for
from world_server.verdict import Verdict


def best(call: Callable[[], object], number: int = 1000, repeat: int = 15) -> float:
    """Least time of one call, us."""
    return min(timeit.repeat(call, number=number, repeat=repeat)) / number * 1e6


def warm_up_seconds(scenario: Scenario, points: np.ndarray) -> float:
    """Least time of a whole warm-up, s."""
    times = []
    for _ in range(5):
        began = time.perf_counter()
        Field(scenario).warm_up(points)
        times.append(time.perf_counter() - began)
    return min(times)


def main() -> None:
    scenario = Scenario(seed=1)
    starts = np.column_stack([np.full(5, 95.0), np.arange(-48.0, -33.0, 3.0)])
    field = Field(scenario)
    field.warm_up(starts)
    wind, plume = field.wind, field.plume
    filaments = plume.positions
    smelly = np.array([[80.0, 80.0, 77.0, 83.0, 60.0], filaments[1, 100:105]])  # robots in and near the plume
    bodies = Bodies(scenario.body, scenario.timing, starts[:, 0], starts[:, 1], np.full(5, 1.57))
    verdict = Verdict(scenario.source, bodies.hands())
    left, right = np.full(5, 0.3), np.full(5, 0.31)
    path = bodies.step(left, right)
    noise = StepNoise(1, "bench")

    def after_a_step() -> object:
        plume._index = None  # as the first question after a step finds it
        return plume.concentration(*smelly)

    rows = [
        ("generator made afresh", best(lambda: generator_for(1, "bench", 7))),
        ("generator moved to a step", best(lambda: noise.at(7))),
        ("wind: advance", best(wind.advance)),
        ("wind: at 5 points", best(lambda: wind.at(*smelly))),
        (f"wind: at {plume.alive} filaments", best(lambda: wind.at_points(filaments))),
        (f"plume: advance, {plume.alive} filaments", best(lambda: plume.advance(wind), number=500)),
        ("plume: concentration at 5 points, first after a step", best(after_a_step)),
        ("plume: concentration at 5 points, again", best(lambda: plume.concentration(*smelly))),
        ("bodies: step of 5 robots, 5 substeps", best(lambda: bodies.step(left, right))),
        ("verdict: judge a tick of 5 robots", best(lambda: verdict.judge(path, 0.0))),
    ]
    width = max(len(name) for name, _ in rows)
    for name, cost in rows:
        print(f"{name:<{width}}  {cost:8.1f} us")
    print(f"{'warm-up of 300 s':<{width}}  {warm_up_seconds(scenario, starts):8.3f} s")


if __name__ == "__main__":
    main()
