"""The swarm that a random fault schedule is for: how many robots, which law, which graphs, how well they sense.

Rules: every draw is addressed ("schedule", part), so that a part that draws more moves no other; every swarm is one that
`check` accepts. Robots start near the plume, some near the source, so that a few simulated seconds hold search, detection,
tracing, and sometimes the end.
"""

from __future__ import annotations

from deploy.faults.random_fault import below, one
from protocol.randomness import Draws, rng_for
from robot_agent.algorithms import ALGORITHMS

MOST_ROBOTS = 9
GRAPHS = ("all", "ring", "line", "star", "k-nearest", "random", "range-limited", "directed-ring")
# x of the column that they start from, m: the source is at (10, 0), and they set out towards larger x.
AT_THE_SOURCE, NEAR, FAR = 8.5, 25.0, 60.0

Values = dict[str, object]  # by dotted name, as flags are


def random_swarm(number: int, max_time: float) -> Values:
    """The values of schedule `number`, all but its faults, that are not the defaults.

    Args:
        max_time: of the run, simulated s; switching happens within it.
    """
    draws = rng_for(number, "schedule", "swarm")
    robots = 2 + below(draws, MOST_ROBOTS - 1)
    algorithm = one(draws, tuple(ALGORITHMS))
    return {
        "seed": number,
        "max_time": max_time,
        "robots": robots,
        "algorithm": algorithm,
        "start.x": one(draws, (AT_THE_SOURCE, NEAR, FAR, FAR)),
        "start.y": -1.5 * robots,
        "plume.warm_up": 120.0,
        **_graphs(rng_for(number, "schedule", "graphs"), robots, max_time),
        **_beliefs(rng_for(number, "schedule", "beliefs")),
        **_world(rng_for(number, "schedule", "world")),
        **(_stop(rng_for(number, "schedule", "stop")) if ALGORITHMS[algorithm].declares else {}),
    }


def _graphs(draws: Draws, robots: int, max_time: float) -> Values:
    """One graph, or two to four that take turns, once or again and again."""
    options: Values = {
        "graph_options.nearest": 1 + below(draws, 3) if robots < 4 else 2 + below(draws, 3),
        "graph_options.mean_degree": round(1.0 + 4.0 * draws.uniform(), 1),
        "graph_options.range": round(3.0 + 20.0 * draws.uniform(), 1),
    }
    if draws.uniform() < 0.6:
        return {**options, "topology": one(draws, GRAPHS)}
    stages: list[Values] = []
    at = 0.0
    for _ in range(2 + below(draws, 3)):
        stage: Values = {"at": round(at, 2), "name": one(draws, GRAPHS)}
        if draws.uniform() < 0.3:
            stage["range"] = round(3.0 + 20.0 * draws.uniform(), 1)
        stages.append(stage)
        at += 0.2 + draws.uniform() * max_time / 3.0
    if draws.uniform() < 0.5:
        options["graph_options.period"] = round(at, 2)
    return {**options, "topology": stages}


def _beliefs(draws: Draws) -> Values:
    """How robots make up their minds."""
    values: Values = {}
    if draws.uniform() < 0.35:
        values["fusion.kind"] = "resilient"
        values["fusion.filter"] = one(draws, ("trimmed", "median"))
        values["fusion.liars"] = below(draws, 3)
    if draws.uniform() < 0.2:
        values["fusion.input"] = "always"
    if draws.uniform() < 0.15:
        values["fusion.step"] = "explicit"
    if draws.uniform() < 0.15:
        values["trust.check"] = False
    if draws.uniform() < 0.15:
        values["control.relay"] = False
    if draws.uniform() < 0.2:
        values["decision.lost_after"] = 2.0
    if draws.uniform() < 0.3:
        values["timing.stale_after"] = one(draws, (0.1, 0.2, 2.0))
    return values


def _world(draws: Draws) -> Values:
    """How the wind blows, how well is sensed, how often is steered."""
    values: Values = {}
    if draws.uniform() < 0.4:
        values["sensors.position_noise"] = round(draws.uniform(), 2)
        values["sensors.heading_noise"] = round(0.1 * draws.uniform(), 3)
        values["sensors.wind_noise"] = round(0.3 * draws.uniform(), 2)
        values["sensors.concentration_noise"] = round(0.5 * draws.uniform(), 2)
    if draws.uniform() < 0.3:
        values["wind.gain"] = round(2.0 * draws.uniform(), 2)
    if draws.uniform() < 0.1:
        values["plume.release_rate"] = 0.0
    values["timing.tick"] = one(draws, (0.05, 0.05, 0.1))
    return values


def _stop(draws: Draws) -> Values:
    """Of an algorithm that can declare: half of the runs end by the swarm's own word, some of these easily."""
    if draws.uniform() < 0.4:
        return {}
    easily: Values = {
        "declaration.radius": 20.0,
        "declaration.hold": 0.2,
        "declaration.tolerance": 20.0,
        "declaration.meetings": 0,
    }
    return {"declaration.stop": "declared", **(easily if draws.uniform() < 0.7 else {})}
