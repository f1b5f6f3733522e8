"""Random fault schedules: each is a scenario that a file can hold, all of the laboratory comes up, and a try tells all."""

from __future__ import annotations

import time
from pathlib import Path
from types import SimpleNamespace

import msgspec
import pytest

from deploy.faults import trial
from deploy.faults.random_schedule import random_scenario
from deploy.faults.random_swarm import GRAPHS, random_swarm
from deploy.faults.trial import try_schedule
from deploy.memory_run import run_in_memory
from protocol.scenario.dump import dump_toml
from protocol.scenario.faults import KINDS, Crash
from protocol.scenario.load import load_scenario
from robot_agent.algorithms import ALGORITHMS

SHORT = 0.5  # s


@pytest.mark.parametrize("number", range(40))
def test_every_number_is_a_scenario_that_a_file_can_hold(number: int, tmp_path: Path) -> None:
    scenario = random_scenario(number)
    (tmp_path / "s.toml").write_text(dump_toml(scenario))
    assert load_scenario(tmp_path / "s.toml") == scenario
    assert random_scenario(number) == scenario


def test_all_of_the_laboratory_comes_up() -> None:
    scenarios = [random_scenario(number) for number in range(300)]
    faults = [fault for scenario in scenarios for fault in scenario.faults]
    assert {fault.__struct_config__.tag for fault in faults} == KINDS.keys()
    assert {scenario.algorithm for scenario in scenarios} == ALGORITHMS.keys()
    assert {scenario.robots for scenario in scenarios} == set(range(2, 10))
    names = [scenario.topology for scenario in scenarios]
    assert set(GRAPHS) <= set(names)
    assert any(" > " in name for name in names)
    assert any(isinstance(fault, Crash) and fault.restart for fault in faults)
    assert {scenario.fusion.kind for scenario in scenarios} == {"plain", "resilient"}
    assert any(s.algorithm == "plume-map" and s.declaration.stop == "declared" for s in scenarios)
    assert any(s.sensors.position_noise for s in scenarios)


def test_a_schedule_of_another_length_has_the_same_swarm() -> None:
    one, other = random_swarm(7, 8.0), random_swarm(7, 3.0)
    assert {key for key in one if one[key] != other[key]} <= {"max_time", "topology", "graph_options.period"}


def test_a_try_of_a_sound_run_finds_nothing_wrong() -> None:
    found = try_schedule(3, "memory", SHORT, 60.0)
    assert found.wrong == ()
    assert found.ended in trial.ENDS


def test_a_run_that_is_another_the_second_time_is_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    def drifting(scenario, *, history=None, wire=False):
        outcome = run_in_memory(scenario, history=history, wire=wire)
        return msgspec.structs.replace(outcome, digest="another") if wire else outcome

    monkeypatch.setattr(trial, "run_in_memory", drifting)
    assert try_schedule(3, "memory", SHORT, 60.0).wrong[0].startswith("digest is not as the second time: ")


def test_a_run_that_raises_or_hangs_is_a_failure_and_says_where(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trial, "run_in_memory", lambda *_, **__: {}["nobody"])
    assert try_schedule(3, "memory", SHORT, 60.0).wrong[0].startswith("KeyError in ")
    monkeypatch.setattr(trial, "run_in_memory", lambda *_, **__: time.sleep(60.0))
    assert try_schedule(3, "memory", SHORT, 0.05).wrong[0].startswith("hangs: no end within 0.05 s, in ")


def test_a_broken_promise_is_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trial, "unplanned", lambda _: [SimpleNamespace(name="order", counterexample="tick 3 after tick 4")])
    assert try_schedule(3, "memory", SHORT, 60.0).wrong == ("order: tick 3 after tick 4",)
