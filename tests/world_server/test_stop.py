"""Chapter 2's own end of a search: a robot that meets 19515 ppt, wherever it is."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from deploy.memory_run import MemorySwarm, run_in_memory
from protocol.errors import ScenarioError
from protocol.scenario import RobotScenario, Scenario, robot_view
from protocol.scenario.dump import dump_toml
from protocol.scenario.load import load_scenario
from protocol.scenario.sections import Source
from world_server.verdict import Found, Verdict

ENOUGH = Source(x=10.0, y=0.0, radius=1.0, stop="concentration", stop_concentration=19515.0)
FAR = np.array([[50.0, 0.0], [60.0, 0.0], [70.0, 0.0]])
ALL = {0, 1, 2}


def beside_the_source(**values: object) -> Scenario:
    """Robots that wait in the plume, some metres downwind."""
    chosen: dict[str, object] = {
        "start.positions": [[14.0, -2.0], [14.0, 0.0], [14.0, 2.0]], "robots": 3, "plume.warm_up": 40.0, "max_time": 20.0,
        "source.stop": "concentration", "case": 1, "search.speed": 0.01,
    }  # fmt: skip
    chosen |= {name.replace("__", "."): value for name, value in values.items()}
    return load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])


def test_enough_odour_ends_the_search_at_the_instant_of_the_sample() -> None:
    verdict = Verdict(ENOUGH, FAR)
    verdict.smell([0.0, 19514.9, 700.0], 3.0, ALL)
    assert verdict.found is None
    verdict.smell([0.0, 19515.0, 700.0], 4.0, ALL)
    assert verdict.found == Found(1, 4.0)


def test_of_two_the_one_that_meets_more_finds_and_a_dead_one_does_not() -> None:
    verdict = Verdict(ENOUGH, FAR)
    verdict.smell([20000.0, 21000.0, 90000.0], 4.0, {0, 1})
    assert verdict.found == Found(1, 4.0)
    verdict.smell([30000.0, 0.0, 0.0], 5.0, ALL)
    assert verdict.found == Found(1, 4.0)


def test_place_does_not_count_where_concentration_does_and_the_other_way_round() -> None:
    at_the_source = np.array([[10.0, 0.0], [60.0, 0.0]])
    assert Verdict(ENOUGH, at_the_source).found is None
    verdict = Verdict(msgspec.structs.replace(ENOUGH, stop="circle"), FAR)
    verdict.smell([1e9, 1e9, 1e9], 4.0, ALL)
    assert verdict.found is None


def test_run_ends_as_found_when_the_sensor_of_some_robot_meets_enough() -> None:
    scenario = beside_the_source()
    swarm = MemorySwarm(scenario)
    swarm.start()
    seen: list[tuple[float, list[float]]] = [(0.0, list(swarm.session.world.concentration))]
    while not swarm.session.over:
        swarm.tick()
        seen.append((swarm.session.world.t, list(swarm.session.world.concentration)))
    t, ppt = next((t, ppt) for t, ppt in seen if max(ppt) >= 19515.0)
    outcome = run_in_memory(scenario)
    assert outcome.found
    assert outcome.ended == "found"
    assert outcome.time == pytest.approx(t)
    assert outcome.finder == ppt.index(max(ppt))


def test_concentration_that_nobody_meets_is_a_time_out_even_at_the_source() -> None:
    places = [[10.0, 0.0], [14.0, 0.0], [14.0, 3.0]]
    outcome = run_in_memory(beside_the_source(source__stop_concentration=1e8, start__positions=places, max_time=2.0))
    assert not outcome.found
    assert outcome.ended == "time out"


def test_robots_know_nothing_of_how_the_source_is_found() -> None:
    assert "source" not in RobotScenario.__struct_fields__
    view = robot_view(beside_the_source(source__stop_concentration=12345.6789), 0)
    assert b"12345.6789" not in msgspec.json.encode(view)


def test_the_end_of_chapter_2_can_be_written_down_and_read_back(tmp_path) -> None:
    scenario = beside_the_source(source__stop_concentration=20000.0)
    file = tmp_path / "scenario.toml"
    file.write_text(dump_toml(scenario))
    assert load_scenario(file) == scenario


def test_unknown_end_is_refused_in_a_sentence() -> None:
    with pytest.raises(ScenarioError, match=r'source.stop is "ring"; it must be "circle" or "concentration"'):
        beside_the_source(source__stop="ring")
