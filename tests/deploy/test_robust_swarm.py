"""Whole swarms in memory: judging, ghosts and rejoining change nothing where nothing is wrong, and help where it is."""

import math

import pytest
from msgspec.structs import replace
from swarm_helpers import near_the_plume

from deploy.memory_run import MemorySwarm

ALGORITHMS = ["cfpso", "dcs", "ftmcs", "simple", "pso", "ppso-im", "lpso", "ccs-like", "surge", "random-walk", "cfpso-ft"]


def run(scenario, prepare=lambda swarm: None, each=lambda swarm: None):
    swarm = MemorySwarm(scenario)
    prepare(swarm)
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
        each(swarm)
    return swarm


def agents(swarm):
    return {i: robot.session.agent for i, robot in swarm.robots.items()}


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_where_nothing_is_wrong_nothing_is_rejected_and_not_a_bit_changes(algorithm):
    digests = set()
    for switches in ({}, {"trust__check": False, "control__remember": 0.0}):
        swarm = run(near_the_plume(algorithm=algorithm, topology="line", robots=6, max_time=6.0, **switches))
        digests.add(swarm.session.world.digest)
        assert all(agent.validation.total == 0 for agent in agents(swarm).values())
    assert len(digests) == 1


def lying(change):
    """Makes robot 2 tell `change(state)` from tick 20 on."""

    def prepare(swarm):
        session = swarm.robots[2].session
        sense = session._sense
        session._sense = lambda reading: change(sense(reading)) if reading.tick >= 20 else sense(reading)

    return prepare


def far(state):
    return replace(state, fusion_x=100.0, fusion_y=50.0)


def farthest(swarm):
    """How far the honest robots' fusion states are from the nearest robot's own estimate, m."""
    honest = [agent._decision for i, agent in agents(swarm).items() if i != 2]
    estimates = [decision.estimate for decision in honest]
    return max(min(math.dist(d.state, (e.x, e.y)) for e in estimates) for d in honest)


def test_one_liar_pulls_the_plain_fusion_away_and_not_the_resilient_one():
    values = {"topology": "all", "max_time": 20.0, "seed": 1}
    plain = run(near_the_plume(**values), lying(far))
    resilient = run(near_the_plume(fusion__kind="resilient", **values), lying(far))
    assert farthest(plain) > 3.0 * farthest(resilient)


def test_a_robot_that_teleports_is_not_used_by_anybody():
    def teleport(state):
        return replace(state, x=state.x + (30.0 if state.tick % 2 else 0.0))

    swarm = run(near_the_plume(algorithm="dcs", topology="all", max_time=5.0), lying(teleport))
    for i, agent in agents(swarm).items():
        if i != 2:
            assert 2 not in [s.robot for _, s in agent._neighbours.fresh]
            assert agent.validation.rejected[2, "jump"] > 10
            assert {j for j, _ in agent.validation.rejected} == {2}
            assert swarm.session.reports[i].refused == agent.validation.total


def test_others_keep_clear_of_a_robot_that_died_in_their_way():
    """Robot 0 leads the column; it dies, and those behind it come by."""
    closest = {}
    for remember in (0.0, 600.0):
        gap = math.inf

        def each(swarm):
            nonlocal gap
            if swarm.session.world.tick == 100:
                swarm.kill(4)
            if swarm.session.world.tick > 100:
                hands = swarm.session.world.bodies.hands()
                gap = min(gap, *(math.dist(hands[4], hands[i]) for i in range(4)))

        column = tuple((60.0, -40.0 + 1.5 * i) for i in range(5))
        scenario = near_the_plume(
            algorithm="cfpso", topology="ring", max_time=25.0, start__positions=column, search__target=(60.0, 50.0),
            control__remember=remember, plume__release_rate=0.0, plume__warm_up=0.0,
        )  # fmt: skip
        run(scenario, each=each)
        closest[remember] = gap
    assert closest[600.0] > 0.6
    assert closest[0.0] < 0.4


@pytest.mark.parametrize(("algorithm", "topology"), [("cfpso", "ring"), ("dcs", "all"), ("ftmcs", "line")])
def test_a_robot_that_is_begun_anew_takes_back_the_decision_from_its_neighbours(algorithm, topology, tmp_path):
    from protocol.scenario.load import load_scenario

    file = tmp_path / "crash.toml"
    file.write_text('[[faults]]\nkind = "crash"\nat = 4.0\nrobot = 2\nrestart = 1.0\n')
    values = {"algorithm": algorithm, "topology": topology, "start.y": -6.0, "start.x": 60.0, "plume.warm_up": 120.0,
              "max_time": 9.0}  # fmt: skip
    scenario = load_scenario(file, overrides=[(name, value, "test") for name, value in values.items()])
    took_back = []

    def each(swarm):
        agent = swarm.robots[2].session.agent
        if agent.rejoined is not None and not took_back:
            others = [a._decision.state for i, a in agents(swarm).items() if i != 2]
            took_back.append((agent.rejoined, agent._decision.state, others))

    digests = {run(scenario, each=each).session.world.digest for _ in range(2)}
    assert len(digests) == 1
    ((tick, (x, y), others),) = took_back
    assert 100 <= tick <= 104
    assert min(p[0] for p in others) - 0.5 <= x <= max(p[0] for p in others) + 0.5
    assert min(p[1] for p in others) - 0.5 <= y <= max(p[1] for p in others) + 0.5
