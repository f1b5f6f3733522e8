"""Whole runs in memory: the same to the bit, whatever carries the messages and however often."""

import pytest
from swarm_helpers import near_the_plume

from deploy.memory_run import MemorySwarm, run_in_memory
from protocol.messages import Shared
from protocol.topology.named import TOPOLOGIES
from robot_agent.algorithms import ALGORITHMS


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("topology", ["all", "ring", "line", "star"])
def test_digest_is_the_same_by_reference_and_through_the_codec(algorithm, topology):
    scenario = near_the_plume(algorithm=algorithm, topology=topology, seed=3)
    by_reference = run_in_memory(scenario)
    through_codec = run_in_memory(scenario, wire=True)
    assert by_reference.first_detection is not None
    assert by_reference.digest == through_codec.digest
    assert through_codec.messages["refused"] == 0


def test_digest_repeats_with_the_seed_and_changes_with_it():
    digests = [run_in_memory(near_the_plume(seed=seed, max_time=3.0)).digest for seed in (1, 1, 2)]
    assert digests[0] == digests[1] != digests[2]


def test_digest_does_not_depend_on_advancing_the_field_early():
    scenario = near_the_plume()
    plain, eager = MemorySwarm(scenario), MemorySwarm(scenario)
    for swarm in (plain, eager):
        swarm.start()
    while not plain.session.over:
        plain.tick()
        eager.session.world.prepare()
        eager.tick()
        assert eager.session.world.concentration == plain.session.world.concentration
    assert eager.session.world.digest == plain.session.world.digest


@pytest.mark.parametrize("topology", [name for name, each in TOPOLOGIES.items() if each.robots is None])
@pytest.mark.parametrize("robots", [1, 2, 6])
def test_every_topology_runs_with_any_number_of_robots(topology, robots):
    outcome = run_in_memory(near_the_plume(topology=topology, robots=robots, max_time=2.0))
    assert outcome.ticks == 40
    assert outcome.ended == "time out"


def test_robots_hear_their_neighbours_only():
    scenario = near_the_plume(topology="line")
    swarm = MemorySwarm(scenario)
    heard: dict[int, set[int]] = {i: set() for i in range(5)}
    for i, robot in swarm.robots.items():
        take = robot.session.take_shared

        def listen(state: Shared, i=i, take=take) -> bool:
            heard[i].add(state.robot)
            return take(state)

        robot.session.take_shared = listen
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
    assert heard == {0: {1}, 1: {0, 2}, 2: {1, 3}, 3: {2, 4}, 4: {3}}


def test_detection_travels_one_edge_a_tick():
    """Robot 0 of a line smells the odour; robot 4 has heard of it four ticks later, and not before."""
    swarm = MemorySwarm(near_the_plume(topology="line", start__y=-30.0))
    swarm.start()
    swarm.tick()
    agents = [robot.session.agent for robot in swarm.robots.values()]
    agents[0]._group.detect(0.0, 900.0, 60.0, 0.0)
    for hops in range(5):
        assert [agent._group.started for agent in agents] == [i <= hops for i in range(5)]
        swarm.tick()
    assert all(agent._group.best == 900.0 for agent in agents)


def test_search_heading_is_agreed_by_the_lowest_number():
    swarm = MemorySwarm(near_the_plume(topology="ring", start__y=-40.0))
    swarm.start()
    for _ in range(4):
        swarm.tick()
    headings = {robot.session.agent._group.heading for robot in swarm.robots.values()}
    leaders = {robot.session.agent._group.leg_by for robot in swarm.robots.values()}
    assert len(headings) == 1
    assert leaders == {0}
