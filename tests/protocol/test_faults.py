"""Faults in a scenario: how they are written, what is refused, and what a robot may know of them."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from protocol.errors import ScenarioError
from protocol.scenario import Scenario, robot_view, scenario_digest
from protocol.scenario.dump import dump_toml
from protocol.scenario.faults import KINDS, ClockSkew, Crash, Liar, Loss, Partition
from protocol.scenario.load import load_scenario, parse_setting

EVERY_KIND = """
robots = 5
topology = "ring"
faults = [
    {kind = "crash", robot = 0, at = 3.0, restart = 2.0},
    {kind = "hang", robot = 1, at = 1.0, until = 2.5},
    {kind = "loss", probability = 0.3, edges = [[0, 1], [1, 0]]},
    {kind = "delay", delay = 0.2, jitter = 0.1},
    {kind = "duplicate", probability = 0.2},
    {kind = "reorder", probability = 0.2},
    {kind = "partition", groups = [[0, 1], [2, 3, 4]], one_way = true},
    {kind = "clock-skew", robot = 2, offset = 1.0, drift = 0.01},
    {kind = "sensor", robot = 3, which = "wind", how = "dropout"},
    {kind = "actuator", robot = 3, wheel = "left", strength = 0.5},
    {kind = "liar", robot = 4, lies = "fusion", offset = [20.0, -5.0]},
    {kind = "world-slow", pause = 0.01},
]
"""


def given(text: str) -> Scenario:
    return load_scenario(None, overrides=[(*parse_setting(text), "--set " + text.partition("=")[0])])


def test_every_kind_can_be_written_in_a_file_and_survives_printing(tmp_path: Path) -> None:
    file = tmp_path / "scenario.toml"
    file.write_text(EVERY_KIND)
    scenario = load_scenario(file)
    assert [fault.__struct_config__.tag for fault in scenario.faults] == list(KINDS)
    file.write_text(dump_toml(scenario))
    assert load_scenario(file) == scenario
    assert msgspec.json.decode(msgspec.json.encode(scenario), type=Scenario) == scenario
    assert all(fault.about() for fault in scenario.faults)


def test_tables_one_under_the_other_and_a_flag_say_the_same(tmp_path: Path) -> None:
    file = tmp_path / "scenario.toml"
    file.write_text('[[faults]]\nkind = "loss"\nprobability = 0.3\n\n[[faults]]\nkind = "crash"\nrobot = 1\nat = 5\n')
    by_flag = given('faults=[{kind="loss", probability=0.3}, {kind="crash", robot=1, at=5}]')
    assert load_scenario(file) == by_flag
    assert by_flag.faults == (Loss(probability=0.3), Crash(robot=1, at=5.0))
    assert scenario_digest(by_flag) != scenario_digest(load_scenario(None))


REFUSED = [
    ("faults=3", "--set faults: faults is 3; it must be a list of tables, for example"),
    ("faults=[{}]", "--set faults: [[faults]] 1: kind is missing; it must be"),
    ('faults=[{kind="los"}]', 'kind is "los"; it must be'),
    ('faults=[{kind="loss"}]', "[[faults]] 1 (loss): probability is missing; it must be a number from 0 to 1."),
    ('faults=[{kind="loss", probability=2}]', "probability is 2; it must be a number from 0 to 1."),
    ('faults=[{kind="loss", probability=nan}]', "probability is nan; it must be a number from 0 to 1."),
    ('faults=[{kind="loss", probabilty=0.2}]', 'there is no value "probabilty"; did you mean "probability"?'),
    ('faults=[{kind="loss", probability=0.2, edges=[[0]]}]', "edges is [[0]]; it must be a list, each entry a list"),
    ('faults=[{kind="loss", probability=0.2, edges=[[0, 2]]}]', "robot 0 does not hear robot 2"),
    ('faults=[{kind="loss", probability=0.2, edges=[[0, 9]]}]', "edges names robot 9; it must be from 0 to 4."),
    ('faults=[{kind="crash", robot=5}]', "--set faults: [[faults]] 1 (crash): robot is 5; it must be from 0 to 4."),
    ('faults=[{kind="crash", robot=1, until=3}]', 'there is no value "until"'),
    ('faults=[{kind="hang", robot=1, at=5, until=5}]', "until is 5; it must be greater than at, which is 5."),
    (
        'faults=[{kind="hang", robot=1, at=5, until=9}, {kind="crash", robot=1, at=6}]',
        "[[faults]] 1 and 2 stop robot 1 at the same time",
    ),
    ('faults=[{kind="delay", delay=4}]', "delay plus jitter is 4 s; it must be at most 3.1 s"),
    ('faults=[{kind="partition", groups=[[1], [1, 2]]}]', "robot 1 is in two groups; it must be in one."),
    ('faults=[{kind="partition", groups=[]}]', "groups is empty"),
    (
        'faults=[{kind="sensor", robot=1, which="wind", how="dropout", value=3}]',
        'value is 3; with how = "dropout" it must be from 0 to 1.',
    ),
]


@pytest.mark.parametrize(("text", "words"), REFUSED)
def test_a_bad_fault_is_refused_with_a_sentence_that_says_which_and_why(text: str, words: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        given(text)
    assert words in str(caught.value)
    assert str(caught.value).startswith("--set faults: ")
    assert "\n" not in str(caught.value)


def test_one_fault_may_begin_where_another_of_the_same_robot_ends() -> None:
    scenario = given('faults=[{kind="hang", robot=1, at=5, until=9}, {kind="crash", robot=1, at=9}]')
    assert len(scenario.faults) == 2


def test_a_robot_knows_its_own_lies_and_clock_and_no_other_fault(tmp_path: Path) -> None:
    file = tmp_path / "scenario.toml"
    file.write_text(EVERY_KIND)
    scenario = load_scenario(file)
    known = [robot_view(scenario, i).faults for i in range(5)]
    assert [type(fault) for faults in known for fault in faults] == [ClockSkew, Liar]
    assert known[2]
    assert known[4]


def test_robots_of_no_group_are_a_group_and_one_way_lets_the_later_hear_the_earlier() -> None:
    both, one_way = Partition(groups=((0, 1),)), Partition(groups=((0, 1), (2,)), one_way=True)
    assert both.parts(0, 3)
    assert both.parts(3, 0)
    assert not both.parts(3, 4)
    assert one_way.parts(0, 2)
    assert not one_way.parts(2, 0)
