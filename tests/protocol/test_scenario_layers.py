"""Which value counts when several places give one."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.scenario import Scenario
from protocol.scenario.load import load_scenario, parse_setting
from protocol.scenario.presets import CASES, PRESETS, case_values
from protocol.scenario.schema import convert, get_value, value_types


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "scenario.toml"


def test_nothing_given_is_the_defaults_with_their_graph() -> None:
    scenario = load_scenario(None)
    assert msgspec.structs.replace(scenario, graph=()) == Scenario()
    assert len(scenario.graph) == 10  # a ring of five, both directions


def test_a_file_beats_the_defaults_and_a_flag_beats_the_file(file: Path) -> None:
    file.write_text("robots = 4\nseed = 7\n[wind]\ngain = 1\n")
    scenario = load_scenario(file, overrides=[("robots", 3, "--robots")])
    assert (scenario.robots, scenario.seed, scenario.wind.gain) == (3, 7, 1.0)
    assert isinstance(scenario.wind.gain, float)


def test_the_last_of_two_equal_flags_counts() -> None:
    overrides = [("seed", 1, "--seed"), ("seed", 2, "--set seed")]
    assert load_scenario(None, overrides=overrides).seed == 2


def test_a_preset_named_by_a_flag_lies_below_the_file(file: Path) -> None:
    file.write_text('[plume]\ngrowth = "farrell2"\n')
    scenario = load_scenario(file, overrides=[("preset", "literal", "--preset")])
    assert scenario.preset == "literal"
    assert scenario.plume.growth == "farrell2"
    assert scenario.fusion.input == "always"


def test_a_flag_can_take_back_the_preset_of_a_file(file: Path) -> None:
    file.write_text('preset = "literal"')
    scenario = load_scenario(file, overrides=[("preset", "corrected", "--preset")])
    assert msgspec.structs.replace(scenario, graph=()) == Scenario()


def test_a_case_in_a_file_lies_below_the_values_of_the_file(file: Path) -> None:
    file.write_text("case = 3\n[source]\nx = 11\n")
    scenario = load_scenario(file)
    assert (scenario.case, scenario.source.x, scenario.source.y) == (3, 11.0, -20.0)


def test_a_case_by_flag_beats_the_values_of_the_file(file: Path) -> None:
    file.write_text("case = 3\n[source]\nx = 11\n[wind]\nspeed = 2\n")
    scenario = load_scenario(file, overrides=[("case", 5, "--case")])
    assert (scenario.source.x, scenario.source.y, scenario.wind.speed) == (30.0, 10.0, 1.5)


@pytest.mark.parametrize("first", ["case", "wind"])
def test_a_value_by_flag_beats_the_case_by_flag_in_either_order(first: str) -> None:
    case, wind = ("case", 5, "--case"), ("wind.speed", 2.0, "--wind")
    scenario = load_scenario(None, overrides=[case, wind] if first == "case" else [wind, case])
    assert (scenario.wind.speed, scenario.source.x) == (2.0, 30.0)


def test_case_zero_by_flag_takes_back_the_case_of_a_file(file: Path) -> None:
    file.write_text("case = 3\n[source]\nx = 11\n")
    scenario = load_scenario(file, overrides=[("case", 0, "--case")])
    assert (scenario.case, scenario.source.x, scenario.source.y) == (0, 11.0, Scenario().source.y)


@pytest.mark.parametrize("case", CASES)
def test_every_case_is_a_scenario_that_runs(case: int) -> None:
    scenario = load_scenario(None, overrides=[("case", case, "--case")])
    assert {path: get_value(scenario, path) for path in case_values(case)} == case_values(case)


@pytest.mark.parametrize("preset", PRESETS)
def test_every_value_of_a_preset_is_a_known_value_and_departs_from_the_default(preset: str) -> None:
    for path, value in PRESETS[preset].items():
        assert path in value_types()
        assert convert(path, value) == value
        assert value != get_value(Scenario(), path)
    scenario = load_scenario(None, overrides=[("preset", preset, "--preset")])
    assert {path: get_value(scenario, path) for path in PRESETS[preset]} == PRESETS[preset]


def test_robots_follow_a_topology_of_a_fixed_size() -> None:
    for name, size in (("fig-3.2", 4), ("fig-5.3", 3), ("fig-5.18", 3)):
        scenario = load_scenario(None, overrides=[("topology", name, "--topology")])
        assert scenario.robots == size
        assert {i for i, _, _ in scenario.graph} == set(range(size))


def test_a_graph_file_is_found_beside_the_scenario_that_names_it(tmp_path: Path, file: Path) -> None:
    (tmp_path / "net.toml").write_text("robots = 3\nedges = [[0, 1], [1, 2, 0.5]]")
    file.write_text('topology = "net.toml"')
    scenario = load_scenario(file)
    assert scenario.robots == 3
    assert scenario.graph == ((0, 1, 1.0), (1, 0, 1.0), (1, 2, 0.5), (2, 1, 0.5))


def test_a_graph_file_named_by_a_flag_is_found_from_the_working_directory(
    tmp_path: Path, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file.write_text("seed = 1")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "net.csv").write_text("0,1\n0,0\n")
    monkeypatch.chdir(elsewhere)
    assert load_scenario(file, overrides=[("topology", "net.csv", "--topology")]).graph == ((0, 1, 1.0),)


def test_a_graph_in_the_scenario_stays_and_a_topology_by_flag_replaces_it(file: Path) -> None:
    file.write_text("robots = 3\ngraph = [[0, 1, 2.0]]")
    assert load_scenario(file).graph == ((0, 1, 2.0),)
    assert len(load_scenario(file, overrides=[("topology", "all", "--topology")]).graph) == 6


def test_an_empty_graph_can_be_asked_for(file: Path) -> None:
    file.write_text("graph = []")
    assert load_scenario(file).graph == ()


def test_a_table_can_be_given_by_one_flag() -> None:
    scenario = load_scenario(None, overrides=[(*parse_setting("source={x=5, y=6}"), "--set source")])
    assert (scenario.source.x, scenario.source.y) == (5.0, 6.0)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("wind.gain=1.0", 1.0),
        (" wind.gain = 1 ", 1),
        ("wind.gain=dcs", "dcs"),
        ("wind.gain='a=b'", "a=b"),
        ("wind.gain=a=b", "a=b"),
        ("wind.gain=true", True),
        ("wind.gain=[1, 2]", [1, 2]),
        ("wind.gain=", ""),
        ("wind.gain=1\nseed = 2", "1\nseed = 2"),
        ("wind.gain=3.2.1", "3.2.1"),
    ],
)
def test_a_setting_is_toml_or_else_text(text: str, value: object) -> None:
    assert parse_setting(text) == ("wind.gain", value)


@given(st.text())
def test_any_text_after_a_name_is_a_setting(text: str) -> None:
    assert parse_setting(f"seed={text}")[0] == "seed"
