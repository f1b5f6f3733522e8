"""What a person reads when a scenario is wrong: exactly one sentence with the value, the place and what is allowed."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import inspect, structs

from protocol.errors import ScenarioError
from protocol.scenario import Scenario
from protocol.scenario.check import check
from protocol.scenario.load import Override, load_scenario, parse_setting
from protocol.scenario.schema import value_types
from protocol.scenario.settings import read_settings


def is_one_sentence(text: str) -> bool:
    return "\n" not in text and text[-1] in ".?" and re.search(r"[.?!]\s+[A-Z]", text) is None


def flags(*texts: str) -> list[Override]:
    return [(*parse_setting(text), f"--set {text.partition('=')[0]}") for text in texts]


def refusal(file: Path | None = None, overrides: list[Override] | None = None) -> str:
    with pytest.raises(ScenarioError) as caught:
        load_scenario(file, overrides=overrides or [], algorithms=("cfpso", "dcs", "simple"))
    return str(caught.value)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return Path("scenario.toml")


IN_FILE = [
    ("[wind]\ngain = -1", "scenario.toml: wind.gain is -1; it must be a number from 0 to 20."),
    ("[wind]\ngain = nan", "scenario.toml: wind.gain is nan; it must be a number from 0 to 20."),
    ("[wind]\nspeed = inf", "scenario.toml: wind.speed is inf; it must be a number > 0 and <= 20."),
    ("[wind]\ngan = 1", 'scenario.toml: there is no value "gan" in table "wind"; did you mean "gain"?'),
    ("[wnd]\ngain = 1", 'scenario.toml: there is no table "wnd"; did you mean "wind"?'),
    ("sed = 1", 'scenario.toml: there is no value "sed"; did you mean "seed"?'),
    ("gate_size = 1", 'scenario.toml: there is no value "gate_size"; did you mean "decision.gate_size"?'),
    ("seed = 1.0", "scenario.toml: seed is 1.0; it must be a whole number from 0 to 9223372036854775807."),
    ("seed = {a = 1}", "scenario.toml: seed is a table; it must be a whole number from 0 to 9223372036854775807."),
    ("robots = true", "scenario.toml: robots is true; it must be a whole number from 1 to 1000."),
    ("max_time = '10'", 'scenario.toml: max_time is "10"; it must be a number > 0 and <= 1e+06.'),
    ("topology = 1", "scenario.toml: topology is 1; it must be text."),
    (
        'preset = "literl"',
        'scenario.toml: preset is "literl"; it must be "corrected" or "literal"; did you mean "literal"?',
    ),
    ("[control]\nrelay = 1", "scenario.toml: control.relay is 1; it must be true or false."),
    ("[search]\ntarget = [1]", "scenario.toml: search.target is [1]; it must be a list [a number, a number]."),
    ("wind = 3", "scenario.toml: wind is 3; it must be a table with speed, direction, diffusivity, gain, bandwidth,"
     " damping, nodes, dt."),
    ("graph = [[0, 9, 1]]", "scenario.toml: graph: edge [0, 9] names robot 9; the robots must be numbered 0 to 4."),
    ("graph = [[0, 0, 1]]", "scenario.toml: graph: edge [0, 0] joins a robot to itself; an edge must join two robots."),
    ("graph = [[0, 1, 0]]", "scenario.toml: graph: edge [0, 1] has weight 0; it must be a number > 0."),
    ("graph = [[0, 1, nan]]", "scenario.toml: graph: edge [0, 1] has weight nan; it must be a number > 0."),
    (
        "graph = [[0, 1, 1], [0, 1, 2]]",
        "scenario.toml: graph: edge [0, 1] is given twice; every edge must be given once.",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("text", "sentence"), IN_FILE)
def test_a_wrong_value_in_a_file_is_one_sentence(here: Path, text: str, sentence: str) -> None:
    here.write_text(text)
    assert refusal(here) == sentence
    assert is_one_sentence(sentence)


BY_FLAG = [
    ("wnd.gain=1", '--set wnd.gain: there is no table "wnd"; did you mean "wind"?'),
    ("wind.gain=-1", "--set wind.gain is -1; it must be a number from 0 to 20."),
    ("wind.gain.x=1", '--set wind.gain.x: there is no value "gain.x" in table "wind"; did you mean "gain"?'),
    ("control.relay=False", '--set control.relay is "False"; it must be true or false.'),
    ("case=10", "--set case is 10; it must be a whole number from 0 to 9."),
    ("fusion.lam=2e9", "--set fusion.lam is 2000000000.0; it must be a number from 0 to 1e+09."),
    ("timing.tick=0.055", "--set timing.tick is 0.055; it must be a whole multiple of timing.substep, which is 0.01."),
    (
        "timing.decision=0.12",
        "--set timing.decision is 0.12; it must be a whole multiple of timing.tick, which is 0.05.",
    ),
    ("max_time=0.01", "--set max_time is 0.01; it must be at least one tick, 0.05 s."),
    ("arena.x_min=200", "--set arena.x_min is 200 and arena.x_max is 100; the first must be less than the second."),
    ("source.y=51", "--set source.y: the source is at (10, 51); it must be inside the arena, x from 0 to 100 and"
     " y from -50 to 50."),
    ("start.x=101", "--set start.x: the robots start from (101, -48); it must be inside the arena, x from 0 to 100 and"
     " y from -50 to 50."),
    ("start.positions=[[1, 2]]", "--set start.positions has 1 point; it must have one per robot, 5."),
    ("start.positions=[[1, 2], [3, 2], [1.2, 2.2], [9, 9], [0, 0]]",
     "--set start.positions: robots 0 and 2 start 0.283 m apart; they must be at least 0.4 m apart."),
    ("start.positions=[[1, 2], [3, 2], [1.2, 222], [9, 9], [0, 0]]",
     "--set start.positions: robot 2 starts at (1.2, 222); it must be inside the arena, x from 0 to 100 and"
     " y from -50 to 50."),
    ("network.endpoints=['tcp/a']", "--set network.endpoints has 1 entry; it must be empty or have 6, the world's first"
     " and then one per robot."),
    ("topology=rign", '--set topology: there is no topology "rign"; did you mean "ring"?'),
    ("topology=nowhere.csv", "--set topology: nowhere.csv: there is no such file; give the path of a graph file."),
    ("algorithm=dsc", '--set algorithm is "dsc"; it must be "cfpso", "dcs" or "simple"; did you mean "dcs"?'),
]  # fmt: skip


@pytest.mark.parametrize(("text", "sentence"), BY_FLAG)
def test_a_wrong_value_of_a_flag_is_one_sentence(here: Path, text: str, sentence: str) -> None:
    assert refusal(overrides=flags(text)) == sentence
    assert is_one_sentence(sentence)


def test_robots_that_do_not_fit_the_arena_are_refused_with_how_many_do() -> None:
    sentence = refusal(overrides=flags("robots=1000", "start.spacing=4"))
    assert sentence.startswith("--set robots and --set start.spacing: robots is 1000; it must be at most 600 to start")
    assert is_one_sentence(sentence)
    load_scenario(None, overrides=flags("robots=600", "start.spacing=4"))


def test_a_map_that_forgets_too_fast_for_the_time_of_the_run_is_refused_with_what_will_do() -> None:
    def mapping(*texts: str) -> Scenario:
        return structs.replace(load_scenario(None, overrides=flags("max_time=100000", *texts)), algorithm="plume-map")

    with pytest.raises(ScenarioError) as refused:
        check(mapping("plume_map.forget=150"))
    assert str(refused.value).startswith("plume_map.forget is 150; it must be at least 160.3 where max_time is 100000")
    assert is_one_sentence(str(refused.value))
    check(mapping("plume_map.forget=160.3"))


def test_an_unreadable_file_is_one_sentence(here: Path) -> None:
    assert refusal(here) == "scenario.toml: there is no such file; give the path of a scenario file."
    here.mkdir()
    assert refusal(here) == "scenario.toml: this is a directory; give the path of a scenario file."
    here.rmdir()
    here.write_bytes(b"seed = 1\n# \xff")
    assert refusal(here) == "scenario.toml: byte 11 is not UTF-8 text; a scenario file must be UTF-8."


@pytest.mark.parametrize(
    "text", ["seed =", "seed = 1\nseed = 2", "a = " + "[" * 5000, "seed = " + "9" * 5000, "\x00", "[wind", '"' * 3]
)
def test_a_file_that_is_not_toml_is_one_sentence(here: Path, text: str) -> None:
    here.write_text(text)
    sentence = refusal(here)
    assert sentence.startswith("scenario.toml: this is not valid TOML, ")
    assert is_one_sentence(sentence)


def test_a_flag_and_a_file_that_disagree_are_both_named(here: Path) -> None:
    here.write_text("robots = 5")
    sentence = refusal(here, [("topology", "fig-5.3", "--topology")])
    assert sentence == (
        '--topology and scenario.toml: topology "fig-5.3" has 3 robots and robots is 5; leave robots out, or make it 3.'
    )


def test_a_value_of_a_case_is_blamed_on_the_case() -> None:
    sentence = refusal(overrides=[("case", 3, "--case"), ("arena.y_min", -10.0, "--set arena.y_min")])
    assert sentence.startswith("case 3 (--case): the source is at (30, -20); it must be inside the arena")


def test_a_value_that_a_later_layer_replaces_is_checked_too(here: Path) -> None:
    here.write_text("robots = 0")
    assert refusal(here, [("robots", 3, "--robots")]).startswith("scenario.toml: robots is 0; it must be")


def test_an_unknown_name_with_nothing_near_lists_what_there_is() -> None:
    sentence = refusal(overrides=flags("zzz.y=1"))
    assert sentence.startswith('--set zzz.y: there is no table "zzz"; there is arena, source, wind, ')
    assert is_one_sentence(sentence)


@pytest.mark.parametrize("text", ["", "robots", "=1", " = 1"])
def test_a_setting_without_a_name_or_a_value_is_one_sentence(text: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        parse_setting(text)
    assert str(caught.value).endswith("write NAME=VALUE, for example --set wind.gain=1.0.")
    assert is_one_sentence(str(caught.value))


NUMBERS: dict[str, Any] = {
    path: kind
    for path, kind in ((path, inspect.type_info(each)) for path, each in value_types().items())
    if isinstance(kind, inspect.IntType | inspect.FloatType)
}


def low_and_high(kind: Any) -> tuple[float, float]:
    low = kind.ge if kind.ge is not None else kind.gt
    high = kind.le if kind.le is not None else kind.lt
    return low, high


def test_every_number_of_a_scenario_has_two_bounds() -> None:
    assert [path for path, kind in NUMBERS.items() if None in low_and_high(kind)] == []


@st.composite
def out_of_range(draw: st.DrawFn) -> tuple[str, float]:
    path = draw(st.sampled_from(sorted(NUMBERS)))
    kind = NUMBERS[path]
    low, high = low_and_high(kind)
    if isinstance(kind, inspect.IntType):
        whole = st.integers(max_value=int(low) - 1) | st.integers(min_value=int(high) + 1)
        return path, draw(whole)
    below = st.floats(max_value=low, exclude_max=kind.ge is not None, allow_nan=False)
    above = st.floats(min_value=high, exclude_min=kind.le is not None, allow_nan=False)
    return path, draw(below | above | st.just(math.nan) | st.integers(min_value=math.floor(high) + 1))


@given(out_of_range())
def test_a_number_out_of_range_is_one_sentence_with_value_place_and_range(bad: tuple[str, float]) -> None:
    path, value = bad
    with pytest.raises(ScenarioError) as caught:
        list(read_settings(tuple(path.split(".")), value, "here.toml"))
    sentence = str(caught.value)
    assert sentence.startswith(f"here.toml: {path} is ")
    assert re.search(r"; it must be a (whole )?number (from|>|<)", sentence)
    assert is_one_sentence(sentence)


@given(st.data())
def test_a_number_in_range_is_taken_as_it_is(data: st.DataObject) -> None:
    path = data.draw(st.sampled_from(sorted(NUMBERS)))
    kind = NUMBERS[path]
    low, high = low_and_high(kind)
    if isinstance(kind, inspect.IntType):
        value: float = data.draw(st.integers(int(low), int(high)))
    else:
        value = data.draw(st.floats(low, high, exclude_min=kind.gt is not None, exclude_max=kind.lt is not None))
    (setting,) = read_settings(tuple(path.split(".")), value, "here.toml")
    assert setting.value == value
    assert type(setting.value) is (int if isinstance(kind, inspect.IntType) else float)
