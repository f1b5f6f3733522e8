"""An exercise has no odour: nothing is released, nobody finds anything, and each robot starts as it is told."""

import numpy as np
import pytest

from protocol.errors import ScenarioError
from protocol.messages import Drive
from protocol.scenario import Scenario
from protocol.scenario.load import load_scenario
from world_server.field import Field
from world_server.start import start_poses
from world_server.world import World


def without_source(**values: object) -> Scenario:
    chosen: dict[str, object] = {"robots": 2, "plume.release_rate": 0.0, "sensors.wind_history": 0.0}
    chosen |= {name.replace("__", "."): value for name, value in values.items()}
    return load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])


def test_a_robot_that_stands_where_the_source_would_be_finds_nothing():
    world = World(without_source(start__positions=((10.0, 0.0), (20.0, 0.0))))
    for _ in range(20):
        world.step(world.t, world.next_t, {i: Drive(i, world.tick, 0.1, 0.1) for i in range(2)})
    assert world.found is None
    assert world.first_detection is None
    assert world.field.plume.released == 0
    with_one = World(without_source(start__positions=((10.0, 0.0), (20.0, 0.0)), plume__release_rate=10.0))
    assert with_one.found is not None


def test_without_a_source_there_is_no_time_before_the_start():
    field = Field(without_source())
    field.warm_up(np.zeros((2, 2)))
    assert field.plume.step == 0


def test_each_robot_can_have_its_own_heading():
    poses = start_poses(without_source(start__positions=((1.0, 2.0), (3.0, 4.0)), start__headings=(0.5, -3.0)))
    assert poses.tolist() == [[1.0, 2.0, 0.5], [3.0, 4.0, -3.0]]
    assert start_poses(without_source(start__heading=0.25))[:, 2].tolist() == [0.25, 0.25]


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"start__headings": (1.0,)}, "start.headings has 1 angle; it must be empty or have one per robot, 2."),
        ({"drill__radii": (1.0, 2.0, 3.0)}, "drill.radii has 3 numbers; it must have one for all robots, or one per"),
        ({"drill__radii": ()}, "drill.radii has 0 numbers"),
    ],
)
def test_lists_that_do_not_fit_the_robots_are_refused(values, sentence):
    with pytest.raises(ScenarioError) as refusal:
        without_source(**values)
    assert sentence in str(refusal.value)
