"""What follows from a scenario: what a robot may know of it, its digest, its printed form."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any, get_type_hints

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import inspect

from protocol.scenario import RobotScenario, Scenario, linked_to, robot_view, scenario_digest
from protocol.scenario import sections as s
from protocol.scenario.dump import dump_toml
from protocol.scenario.faults import Crash, Loss
from protocol.scenario.load import build, load_scenario, merge
from protocol.scenario.presets import CASES, PRESETS
from protocol.scenario.realtime import Realtime
from protocol.scenario.schema import convert, get_value, value_types
from protocol.scenario.settings import Setting, read_settings


def another(path: str) -> Any:
    """An allowed value of `path` that is not the default."""
    old = get_value(Scenario(), path)
    match inspect.type_info(value_types()[path]):
        case inspect.BoolType():
            return not old
        case inspect.LiteralType() as kind:
            return next(each for each in kind.values if each != old)
        case inspect.StrType():
            return f"{old}x"
        case inspect.IntType() | inspect.FloatType() as kind:
            low = kind.ge if kind.ge is not None else kind.gt
            high = kind.le if kind.le is not None else kind.lt
            assert isinstance(old, int | float)
            near = (old + 1, old - 1, old / 2 + 0.01, (low + high) / 2)
            return next(each for each in near if each != old and fits(path, each))
    return {
        "graph": ((0, 1, 1.0),),
        "start.positions": ((1.0, 2.0),),
        "start.headings": (1.0,),
        "search.target": (1.0, 2.0),
        "drill.velocity": (1.0, 2.0),
        "drill.centre": (1.0, 2.0),
        "drill.radii": (1.0, 2.0),
        "network.endpoints": ("tcp/127.0.0.1:7447",),
        "sensors.proximity": 2.5,
        "faults": (Loss(probability=0.3, edges=((0, 1),)), Crash(robot=1, at=3.0)),
    }[path]


def fits(path: str, value: object) -> bool:
    try:
        convert(path, value)
    except msgspec.ValidationError:
        return False
    return True


def changed(path: str) -> Scenario:
    return build([Setting(path, another(path), "test")])


@pytest.mark.parametrize("path", value_types())
def test_the_digest_changes_with_every_value_that_decides_the_run_and_with_no_other(path: str) -> None:
    same = scenario_digest(changed(path)) == scenario_digest(Scenario())
    assert same == path.startswith(("network.", "recording.", "realtime.", "supervision."))


def test_the_digest_of_a_run_in_real_time_changes_with_the_speed() -> None:
    digests = {
        scenario_digest(Scenario(clock=clock, realtime=Realtime(speed=speed)))
        for clock in ("lockstep", "realtime")
        for speed in (1.0, 2.0)
    }
    assert len(digests) == 3


def test_a_robot_knows_no_table_that_only_the_world_knows() -> None:
    kinds = set(get_type_hints(RobotScenario).values())
    assert kinds.isdisjoint({s.Source, s.Wind, s.Plume, s.Sensors, s.Start, s.Recording, Scenario})


def walk(item: object) -> list[object]:
    """All plain values in a record, however deep."""
    if isinstance(item, msgspec.Struct):
        return [value for name in item.__struct_fields__ for value in walk(getattr(item, name))]
    if isinstance(item, tuple):
        return [value for each in item for value in walk(each)]
    return [item]


def test_a_robot_finds_nothing_of_source_wind_plume_or_starts_in_any_field() -> None:
    hidden = [path for path in value_types() if path.startswith(("source.", "wind.", "plume.", "sensors.", "start."))]
    marks = {path: 0.0101 + 0.00010003 * n for n, path in enumerate(hidden)}  # numbers that occur nowhere else
    numbers = {
        path: mark
        for path, mark in marks.items()
        if isinstance(inspect.type_info(value_types()[path]), inspect.FloatType) and fits(path, mark)
    }
    assert len(numbers) >= 18
    positions = ((7.7701, 7.7702), (7.7703, 7.7704), (7.7705, 7.7706))
    settings = [Setting(path, mark, "test") for path, mark in numbers.items()]
    scenario = build([*settings, Setting("start.positions", positions, "test"), Setting("robots", 3, "test")])
    secrets = {*numbers.values(), *(number for point in positions for number in point)}
    assert secrets <= set(walk(scenario))
    for i in range(3):
        known = walk(robot_view(scenario, i))
        assert secrets.isdisjoint(known)
        assert not any(isinstance(each, dict | list) for each in known)


def test_a_robot_knows_its_own_row_and_its_links_and_no_others() -> None:
    scenario = msgspec.structs.replace(Scenario(), robots=4, graph=((0, 1, 2.0), (0, 2, 0.5), (2, 0, 1.0), (3, 1, 4.0)))
    views = [robot_view(scenario, i) for i in range(4)]
    assert [view.row for view in views] == [((1, 2.0), (2, 0.5)), (), ((0, 1.0),), ((1, 4.0),)]
    assert [view.linked for view in views] == [(1, 2), (0, 3), (0,), (1,)]
    assert [linked_to(scenario.graph, i) for i in range(4)] == [view.linked for view in views]
    assert {view.max_degree for view in views} == {4.0}
    assert {view.complete for view in views} == {False}


def reload(text: str, tmp_path: Path) -> Scenario:
    file = tmp_path / "printed.toml"
    file.write_text(text)
    return load_scenario(file)


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("case", [0, *CASES])
@pytest.mark.parametrize("topology", ["ring", "fig-5.3"])
def test_a_printed_scenario_gives_itself_again(preset: str, case: int, topology: str, tmp_path: Path) -> None:
    overrides = [("preset", preset, "--preset"), ("case", case, "--case"), ("topology", topology, "--topology")]
    # Values that take a part of the preset and of the case back to the default.
    overrides += [("plume.growth", "farrell1", "--set plume.growth"), ("source.x", 10.0, "--source")]
    scenario = load_scenario(None, overrides=overrides)
    assert reload(dump_toml(scenario), tmp_path) == scenario


def test_a_printed_scenario_needs_no_graph_file(tmp_path: Path) -> None:
    net = tmp_path / "net.csv"
    net.write_text("0,1,0\n0,0,0.25\n1,0,0\n")
    scenario = load_scenario(None, overrides=[("topology", str(net), "--topology")])
    net.unlink()
    assert reload(dump_toml(scenario), tmp_path) == scenario


def test_the_default_scenario_prints_no_value() -> None:
    assert tomllib.loads(dump_toml(load_scenario(None))) == {}


def test_only_what_differs_is_printed() -> None:
    scenario = load_scenario(None, overrides=[("robots", 3, "--robots"), ("wind.gain", 1.0, "--set wind.gain")])
    assert tomllib.loads(dump_toml(scenario)) == {"robots": 3, "wind": {"gain": 1.0}}


def value_of(path: str) -> st.SearchStrategy[Any]:
    """Allowed values of `path`."""
    match inspect.type_info(value_types()[path]):
        case inspect.BoolType():
            return st.booleans()
        case inspect.LiteralType() as kind:
            return st.sampled_from(kind.values)
        case inspect.StrType():
            return st.text(st.characters(exclude_categories=["Cs"]))
        case inspect.IntType() as kind:
            return st.integers(kind.ge, kind.le)
        case inspect.FloatType() as kind:
            low, high = kind.gt if kind.ge is None else kind.ge, kind.lt if kind.le is None else kind.le
            return st.floats(low, high, exclude_min=kind.ge is None, exclude_max=kind.le is None)
    numbers = st.floats(-1e9, 1e9)
    return {
        "graph": st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9), numbers), max_size=3).map(tuple),
        "start.positions": st.lists(st.tuples(numbers, numbers), max_size=3).map(tuple),
        "start.headings": st.lists(numbers, max_size=3).map(tuple),
        "faults": st.lists(st.sampled_from(another("faults")), max_size=3).map(tuple),
        "search.target": st.tuples(numbers, numbers),
        "drill.velocity": st.tuples(numbers, numbers),
        "drill.centre": st.tuples(numbers, numbers),
        "drill.radii": st.lists(st.floats(0, 1e9, exclude_min=True), max_size=3).map(tuple),
        "sensors.proximity": st.floats(0.0, 100.0),
        "network.endpoints": st.lists(st.text(st.characters(exclude_categories=["Cs"]))).map(tuple),
    }[path]


@given(st.data())
def test_any_values_survive_printing_and_reading_to_the_bit(data: st.DataObject) -> None:
    paths = data.draw(st.lists(st.sampled_from(sorted(value_types())), unique=True, max_size=8))
    settings = [Setting(path, data.draw(value_of(path)), "test") for path in paths]
    scenario = build(merge([settings]).values())
    read = tuple(read_settings((), tomllib.loads(dump_toml(scenario)), "printed"))
    again = build(merge([read]).values())
    if scenario.graph == () and "graph" not in {setting.path for setting in read}:
        assert scenario.topology  # a name gives it again; loading resolves it
    assert again == scenario
    assert scenario_digest(again) == scenario_digest(scenario)
