"""Runs that end when the swarm says so: what the world makes of it, and what a person and a program get."""

from __future__ import annotations

import json

import pytest
from msgspec.structs import replace
from sure_swarm import AFTER, PLACE, SURE
from swarm_helpers import near_the_plume
from sweep_helpers import plan_of, short_spec, write_spec
from typer.testing import CliRunner

from deploy.cli.app import app
from deploy.memory_run import MemorySwarm, run_in_memory
from deploy.sweep.rows import MEASURED, make_row
from protocol.errors import ScenarioError
from protocol.messages import Drive, Event, Outcome
from protocol.scenario import Scenario
from robot_agent.algorithms import ALGORITHMS
from world_server.declarations import Declarations


@pytest.fixture(autouse=True)
def sure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(ALGORITHMS, "sure", SURE)


def scenario(**values: object) -> Scenario:
    return near_the_plume(**{"algorithm": "sure", "declaration__stop": "declared", "max_time": 30.0, **values})


@pytest.fixture
def outcome() -> Outcome:
    return run_in_memory(scenario())


def test_the_run_ends_when_all_robots_have_declared_one_place(outcome: Outcome) -> None:
    assert (outcome.ended, outcome.failed, outcome.declared, outcome.false_declaration) == ("declared", False, True, False)
    assert (outcome.declared_x, outcome.declared_y) == PLACE
    assert outcome.declaration_error == pytest.approx(0.3)
    assert outcome.declared_at == outcome.time
    assert outcome.time >= outcome.first_detection + AFTER + scenario().declaration.hold
    assert (outcome.found, outcome.reached_at, outcome.declaration_delay) == (False, None, None)


def test_reaching_the_source_is_noted_and_ends_nothing() -> None:
    told: list[Event] = []
    there = scenario(start__positions=[[12.0, 0.0], [13.5, -1.0], [13.5, 1.0]], robots=3, search__speed=0.01)
    outcome = run_in_memory(there, tell=told.append)
    assert outcome.ended == "declared"
    assert outcome.found
    assert 0.0 < outcome.reached_at < outcome.declared_at == outcome.time
    assert outcome.declaration_delay == outcome.declared_at - outcome.reached_at
    texts = [event.text for event in told]
    assert texts.count("the source is reached") == 1
    assert texts.index("the source is reached") < texts.index("all robots declare the same place")
    reached = run_in_memory(replace(there, declaration=replace(there.declaration, stop="reached")))
    assert (reached.ended, reached.time, reached.declared) == ("found", reached.reached_at, False)
    assert reached.reached_at == outcome.reached_at


@pytest.mark.parametrize("topology", ["line", "ring", "all"])
def test_digest_is_the_same_by_reference_and_through_the_codec(topology: str) -> None:
    one, two = (run_in_memory(scenario(topology=topology), wire=wire) for wire in (False, True))
    assert one.declared
    assert (one.digest, one.declared_at, one.declared_by) == (two.digest, two.declared_at, two.declared_by)
    assert two.messages["refused"] == 0


def test_robots_that_die_hold_nobody_up() -> None:
    swarm = MemorySwarm(scenario(topology="all"))
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
        if swarm.session.world.tick == 20:
            swarm.kill(0)
            swarm.kill(3)
    assert swarm.session.ended == "declared"
    assert swarm.session.declarations.common[1] in (1, 2, 4)


def test_a_robot_that_tells_another_place_keeps_the_run_going() -> None:
    said = Declarations()
    here, there = (5.0, 0, 1.0, 2.0), (4.0, 1, 8.0, 9.0)
    assert list(said.take([Drive(1, 9, 0.0, 0.0, there), Drive(0, 9, 0.0, 0.0, here)])) == [(0, here), (1, there)]
    assert not said.agreed({0, 1}, 5.0)
    assert not said.agreed({0, 1, 2}, 5.0)
    assert list(said.take([Drive(0, 10, 0.0, 0.0, there), Drive(1, 10, 0.0, 0.0, there)])) == [(0, there)]
    assert said.agreed({0, 1}, 6.0)
    assert (said.common, said.at) == (there, 6.0)
    assert said.error((8.0, 7.0)) == 2.0


def test_a_place_far_off_or_where_there_is_no_source_is_a_false_declaration() -> None:
    elsewhere = run_in_memory(scenario(source__y=2.5))
    assert elsewhere.declared
    assert elsewhere.false_declaration
    assert elsewhere.declaration_error > 2.0


def test_nobody_declares_in_vain_waiting() -> None:
    outcome = run_in_memory(scenario(max_time=6.0))
    assert (outcome.ended, outcome.declared, outcome.declared_by, outcome.declared_at) == ("time out", False, -1, None)


def test_a_row_of_a_sweep_has_it(outcome: Outcome, tmp_path) -> None:
    job = plan_of(short_spec(tmp_path)).jobs[0]
    row = make_row(job, outcome)
    assert set(MEASURED) <= set(row)
    assert (row["declared"], row["declared_at"], row["false_declaration"]) == (True, outcome.declared_at, False)


def command(*arguments: str):
    return CliRunner().invoke(app, list(arguments))


NEAR = ("--bus", "memory", "--set", "start.x=60", "--set", "start.y=-6", "--max-time", "30", "--set", "plume.warm_up=120")


def test_a_person_and_a_program_are_told_where(outcome: Outcome) -> None:
    run = ("run", "--algorithm", "sure", "--stop", "declared", *NEAR)
    words = command(*run).stdout
    assert "The swarm declared the source at (10.30, 0.00) after" in words
    assert "0.30 m off" in words
    assert "no robot came to the source" in words
    facts = json.loads(command(*run, "--json").stdout)
    assert (facts["ended"], facts["declared"], facts["declared_x"]) == ("declared", True, PLACE[0])


@pytest.mark.parametrize("algorithm", ["cfpso", "surge", "parallel"])
def test_an_algorithm_that_cannot_be_certain_is_refused_with_those_that_can(algorithm: str) -> None:
    ended = command("run", "--algorithm", algorithm, "--stop", "declared", *NEAR)
    assert (ended.exit_code, ended.stdout) == (2, "")
    assert ended.stderr.startswith(f'declaration.stop is "declared", and algorithm "{algorithm}" cannot say how')
    assert "sure" in ended.stderr
    assert ended.stderr.count("\n") == 1


def test_an_end_that_does_not_exist_is_refused() -> None:
    ended = command("run", "--stop", "sometime", *NEAR)
    assert ended.exit_code == 2
    assert '--stop: declaration.stop is "sometime"; it must be "declared" or "reached"' in ended.stderr


def test_a_sweep_refuses_it_before_anything_runs(tmp_path) -> None:
    file = write_spec(tmp_path, 'seeds = {first = 1, count = 1}\nalgorithm = "dcs"\ndeclaration.stop = "declared"\n')
    with pytest.raises(ScenarioError, match=rf'{file}: declaration.stop is "declared", and algorithm "dcs" cannot'):
        plan_of(file)
