"""What range finders tell: exact places in the robot's own frame, of everybody within range and of nobody else."""

import math
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from protocol.scenario import Scenario, proximity
from protocol.scenario.load import load_scenario
from world_server.bodies import Unicycle
from world_server.proximity import near
from world_server.world import World

poses = st.lists(st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(-7, 7)), min_size=1, max_size=6)


@given(poses, st.floats(0.5, 6.0))
def test_everybody_within_range_is_seen_where_it_is_and_nobody_else(places, reach):
    robots = [Unicycle(*place, 0.12) for place in places]
    for i, (robot, seen) in enumerate(zip(robots, near(robots, reach), strict=True)):
        c, s = math.cos(robot.theta), math.sin(robot.theta)
        there = [(robot.hand_x + c * a - s * b, robot.hand_y + s * a + c * b) for a, b in seen]
        far = [math.hypot(o.hand_x - robot.hand_x, o.hand_y - robot.hand_y) for j, o in enumerate(robots) if j != i]
        assert len(seen) == sum(r <= reach for r in far)
        assert all(min(math.dist(p, (o.hand_x, o.hand_y)) for o in robots) < 1e-9 for p in there)
        sizes = [math.hypot(*p) for p in seen]
        assert all(one <= two + 1e-9 for one, two in pairwise(sizes))


def scenario_of(**values: object) -> Scenario:
    chosen: dict[str, object] = {"robots": 3, "topology": "line", "start.spacing": 1.0, "plume.warm_up": 1.0} | values
    return load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])


def test_the_algorithm_asks_for_the_sensor_unless_the_scenario_says_otherwise():
    assert proximity(scenario_of()) == proximity(scenario_of(algorithm="dcs")) == 0.0
    assert proximity(scenario_of(algorithm="plume-map")) == 3.0
    assert proximity(scenario_of(algorithm="plume-map", **{"sensors.proximity": 0})) == 0.0
    assert proximity(scenario_of(algorithm="plume-map", preset="literal")) == 0.0
    assert proximity(scenario_of(**{"sensors.proximity": 2.5})) == 2.5


def test_robots_that_do_not_hear_each_other_see_each_other_and_the_dead_too():
    world = World(scenario_of(**{"sensors.proximity": 2.5}))
    world.lose(1)
    assert [(r.robot, len(r.near)) for r in world.readings()] == [(0, 2), (2, 2)]
    assert all(r.near == () for r in World(scenario_of()).readings())


def test_a_world_that_goes_on_from_a_snapshot_tells_the_same():
    scenario = scenario_of(**{"sensors.proximity": 2.5})
    world = World(scenario)
    world.step(world.t, world.next_t, {})
    assert World.restore(scenario, world.snapshot()).readings() == world.readings()
