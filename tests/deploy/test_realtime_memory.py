"""Real time needs a wall clock, and a run in memory has none."""

import pytest
from swarm_helpers import near_the_plume

from deploy.memory_run import run_in_memory
from protocol.errors import ScenarioError
from protocol.scenario import Scenario
from protocol.scenario.check import check
from protocol.scenario.load import load_scenario
from protocol.scenario.realtime import Realtime


def test_a_run_in_memory_refuses_real_time():
    with pytest.raises(ScenarioError, match='clock is "realtime"'):
        run_in_memory(near_the_plume(clock="realtime"))


def test_a_world_that_catches_up_further_than_robots_bear_is_refused():
    overrides = [("realtime.catch_up", 0.3, "--set realtime.catch_up")]
    with pytest.raises(ScenarioError, match=r"realtime\.catch_up is 0\.3; it must be less than realtime\.late"):
        load_scenario(None, overrides=overrides)
    check(Scenario(realtime=Realtime(catch_up=0.3, late=0.4), graph=((0, 1, 1.0), (1, 0, 1.0)), robots=2))
