"""The laws run on every kind of graph, with the same truth however the messages travel."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from swarm_helpers import near_the_plume

from deploy.memory_run import MemorySwarm, run_in_memory
from deploy.sweep.plan import make_plan
from deploy.sweep.spec import read_spec

SWITCHING = [{"at": 0, "name": "line"}, {"at": 1.0, "name": "star"}, {"at": 1.5, "name": "directed-ring"}]
GRAPHS = {
    "k-nearest": {"topology": "k-nearest"},
    "random": {"topology": "random"},
    "directed-ring": {"topology": "directed-ring"},
    "range-limited": {"topology": "range-limited", "graph_options__range": 7.0},
    "nobody near": {"topology": "range-limited", "graph_options__range": 0.5},
    "switching": {"topology": SWITCHING, "graph_options__period": 2.0},
}


@pytest.mark.parametrize("graph", GRAPHS)
@pytest.mark.parametrize("algorithm", ["cfpso", "dcs", "ftmcs"])
def test_every_law_runs_on_every_graph_and_through_the_codec_alike(graph: str, algorithm: str) -> None:
    scenario = near_the_plume(algorithm=algorithm, seed=3, max_time=6.0, **GRAPHS[graph])
    outcome = run_in_memory(scenario, wire=True)
    assert outcome.ended == "time out"
    assert outcome.messages["dropped"] == outcome.messages["refused"] == 0
    assert outcome.first_detection is not None
    assert outcome.digest == run_in_memory(scenario).digest


def test_robots_hear_exactly_whom_the_stage_and_the_range_allow() -> None:
    stages = [{"at": 0, "name": "ring", "range": 8.0}, {"at": 1.0, "name": "line"}]
    swarm = MemorySwarm(near_the_plume(topology=stages, graph_options__period=2.0, max_time=5.0))
    swarm.start()
    seen = set()
    while not swarm.session.over:
        world = swarm.session.world
        hands, reading = world.bodies.hands(), world.readings()
        gaps = np.linalg.norm(hands[:, None] - hands, axis=-1)
        line = world.tick % 40 >= 20
        for r in reading:
            expected = {j for j in (r.robot - 1, r.robot + 1) if 0 <= j < 5}
            if not line:
                around = {(r.robot - 1) % 5, (r.robot + 1) % 5}
                expected = {j for j in around if gaps[r.robot, j] <= 8.0}
            assert {j for j, _ in r.hears} == expected
            seen.add((line, len(expected)))
        swarm.tick()
    assert len(seen) >= 3, "stage and range have both made a difference"


def test_news_crosses_a_graph_that_is_never_connected_but_jointly_is() -> None:
    """0 - 1 and 2 - 3 for a second, then 1 - 2: what robot 0 smells reaches robot 3."""
    pairs = ([[0, 1], [2, 3]], [[1, 2]])
    stages = [
        {"at": float(n), "name": f"part-{n}", "edges": [[*e, 1.0] for i, j in edges for e in ((i, j), (j, i))]}
        for n, edges in enumerate(pairs)
    ]
    scenario = near_the_plume(robots=4, topology=stages, graph_options__period=2.0, max_time=40.0)
    swarm = MemorySwarm(scenario)
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
    assert swarm.session.world.first_detection is not None
    assert all(robot.session.agent.estimate is not None for robot in swarm.robots.values())


def test_a_sweep_crosses_schedules_with_other_values(tmp_path: Path) -> None:
    file = tmp_path / "s.toml"
    file.write_text(
        "seeds = {first = 1, count = 2}\n[graph_options]\nperiod = 30\n"
        '[grid]\nalgorithm = ["cfpso", "dcs"]\n'
        'topology = ["ring", "random", [{at = 0, name = "line"}, {at = 10, name = "star"}]]\n'
    )
    plan = make_plan(read_spec(file))
    assert len(plan.jobs) == 12
    assert [job.values["topology"] for job in plan.jobs[::2]] == ["ring", "random", "line > star@10"] * 2
    of_seed = [job.scenario.graph for job in plan.jobs if job.values["topology"] == "random"]
    assert of_seed[0] != of_seed[1], "a random graph of its own for every seed"
    assert of_seed[:2] == of_seed[2:]
