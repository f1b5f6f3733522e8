"""Whole runs of plume-map: any number of robots, any graph, poor senses, robots that die or whose clock is wrong."""

import pytest
from swarm_helpers import near_the_plume

from deploy.memory_run import MemorySwarm
from protocol.scenario.load import load_scenario

APART = 0.6  # m


def swarm_of(**values):
    near = {"source__x": 35.0, "start__x": 50.0, "start__y": -8.0, "max_time": 150.0}
    return MemorySwarm(near_the_plume(**{"algorithm": "plume-map", "topology": "line", **near, **values}))


def cells(chart):
    return [*chart.fine.M, *chart.coarse.M]


def play(swarm, at=lambda swarm: None):
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
        at(swarm)
    return swarm.session.world


@pytest.mark.parametrize(
    "values",
    [
        {"sensors__wind_history": 0.0},
        {"sensors__position_noise": 0.1},
        {"wind__gain": 2.0, "topology": "ring"},
        {"robots": 1},
        {"robots": 20, "topology": "ring", "start__spacing": 2.0, "start__y": -20.0},
        {"robots": 3, "topology": "star"},
        {"wind__direction": 2.4, "source__x": 70.0, "source__y": -20.0, "start__x": 60.0, "start__y": -12.0},
    ],
    ids=["no wind history", "position noise", "meander", "alone", "twenty", "star", "another wind"],
)
def test_the_source_is_found(values):
    world = play(swarm_of(**values))
    assert world.found is not None
    if len(world.bodies.robots) > 1:
        assert world.verdict.min_pair_distance > APART


def test_much_position_noise_only_slows():
    world = play(swarm_of(sensors__position_noise=0.5, robots=3))
    assert world.found is not None


def test_the_source_is_found_when_robots_die_and_the_line_falls_apart():
    def kill_two(swarm):
        if swarm.session.world.tick in (100, 200):
            swarm.kill(swarm.session.world.tick // 100)  # 1 and 2: robot 0 is cut off

    world = play(swarm_of(), kill_two)
    assert world.found is not None
    assert world.live == {0, 3, 4}


@pytest.mark.parametrize("skew", [-3.0, 3.0, 100.0])
def test_a_robot_whose_clock_is_wrong_harms_nobody(skew):
    swarm = swarm_of(faults=[{"kind": "clock-skew", "robot": 1, "offset": skew}])
    assert play(swarm).found is not None


def test_robots_with_the_same_events_hold_the_same_map_to_the_bit():
    """On a line events come late and in another order everywhere; when none is under way all maps are one."""
    swarm = swarm_of(max_time=20.0)
    equal = []

    def compare(swarm):
        if swarm.session.world.tick % 20 == 15:
            maps = [cells(robot.session.agent._decision.chart) for robot in swarm.robots.values()]
            equal.append(all(each == maps[0] for each in maps))

    play(swarm, compare)
    assert len(equal) > 15
    assert all(equal)


def test_a_robot_that_heard_nothing_for_a_while_is_told_what_it_missed():
    """Robot 4 of a line is deaf and mute for six seconds: a partition shorter than the window leaves no trace."""
    cut = {"kind": "partition", "at": 3.0, "until": 9.0, "groups": [[0, 1, 2, 3], [4]]}
    swarm = swarm_of(max_time=14.0, faults=[cut])
    apart = []

    def compare(swarm):
        if swarm.session.world.tick == 170:
            maps = [cells(swarm.robots[i].session.agent._decision.chart) for i in (0, 4)]
            apart.append(maps[0] != maps[1])

    play(swarm, compare)
    assert apart == [True]
    charts = [robot.session.agent._decision.chart for robot in swarm.robots.values()]
    assert cells(charts[4]) == cells(charts[0])


@pytest.mark.parametrize(("graph", "most"), [("all", 20.0), ("ring", 54.0)])
def test_a_robot_sends_at_most_about_fifty_bytes_of_events_a_second(graph, most):
    swarm = swarm_of(topology=graph, max_time=10.0)
    sent = []
    for robot in swarm.robots.values():
        events = robot.session.agent._decision.events
        robot.session.agent._decision.events = lambda own, events=events: sent.append(told := events(own)) or told
    play(swarm)
    assert 0 < sum(map(len, sent)) / 10.0 / 5 < most


def test_what_the_recorder_is_shown_is_a_map_of_the_arena():
    swarm = swarm_of(max_time=20.0)
    decision = swarm.robots[0].session.agent._decision
    assert decision.belief_map() is None
    play(swarm)
    x0, y0, cell, rows, levels = decision.belief_map()
    columns = len(levels) // rows
    assert (x0, y0) == (0.0, -50.0)
    assert 100.0 <= rows * cell <= 103.0
    assert 100.0 <= columns * cell <= 103.0
    assert max(levels) == 255
    best = levels.index(255)
    assert abs(x0 + (best % columns + 0.5) * cell - decision.h[0]) < 30.0
    assert abs(y0 + (best // columns + 0.5) * cell - decision.h[1]) < 10.0


def test_a_plume_that_leaves_where_the_group_turns_is_not_taken_for_one_that_begins_there():
    # 10 s after the plume swung away all held its last place for the source, 52 m downwind of it, and had declared it.
    chosen = {"algorithm": "plume-map", "topology": "all", "case": 9, "seed": 41005, "wind.gain": 2.0, "max_time": 80.0,
              "declaration.stop": "declared"}  # fmt: skip
    swarm = MemorySwarm(load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()]))
    sure = []
    world = play(swarm, lambda swarm: sure.append(swarm.robots[0].session.agent._decision.certainty()))
    assert min(radius for radius in sure if radius is not None) < world.scenario.declaration.radius
    assert swarm.session.ended == "time out"
