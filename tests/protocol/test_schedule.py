"""Graphs that switch: how a person gives them, what the scenario holds of them, what a robot knows."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.errors import ScenarioError
from protocol.scenario import Scenario, Stage, robot_view
from protocol.scenario.dump import dump_toml
from protocol.scenario.load import load_scenario
from protocol.scenario.resolve import resolve
from protocol.scenario.stage import stage_at
from protocol.topology.named import build

LINE_STAR = [{"at": 0, "name": "line"}, {"at": 10.0, "name": "star"}]


def load(**values: object) -> Scenario:
    chosen = [(name.replace("__", "."), value, "flag") for name, value in values.items()]
    return load_scenario(None, overrides=chosen)


def test_a_schedule_in_a_file_is_an_array_of_tables(tmp_path: Path) -> None:
    file = tmp_path / "s.toml"
    file.write_text(
        '[[topology]]\nat = 0\nname = "line"\n[[topology]]\nat = 60.0\nname = "ring"\nrange = 20\n'
        "[graph_options]\nperiod = 90\n"
    )
    scenario = load_scenario(file)
    assert scenario.topology == "line > ring<20m@60"
    assert [(s.at, s.name, s.range) for s in scenario.schedule] == [(0.0, "line", 0.0), (60.0, "ring", 20.0)]
    assert [s.edges for s in scenario.schedule] == [build("line", 5).edges, build("ring", 5).edges]
    assert scenario.graph == build("ring", 5).edges
    assert load_scenario(file, overrides=[("topology", "star", "--topology")]).schedule == ()


def test_links_are_the_union_and_sums_are_bounded_by_the_largest_stage() -> None:
    scenario = load(topology=LINE_STAR)
    assert {edge[:2] for edge in scenario.graph} == {
        edge[:2] for name in ("line", "star") for edge in build(name, 5).edges
    }
    view = robot_view(scenario, 1)
    assert view.linked == (0, 2)
    assert view.row == ((0, 1.0), (2, 1.0))
    assert [stage.row for stage in view.stages] == [((0, 1.0), (2, 1.0)), ((0, 1.0),)]
    assert view.max_degree == 4.0  # robot 0 in the star
    assert not view.complete


def test_a_union_has_the_largest_weight_of_an_edge(tmp_path: Path) -> None:
    for name, weight in (("a", 2.0), ("b", 0.5)):
        (tmp_path / f"{name}.json").write_text(f'{{"robots": 2, "edges": [[0, 1, {weight}]], "directed": true}}')
    file = tmp_path / "s.toml"
    file.write_text('topology = [{at = 0, name = "b.json"}, {at = 1, name = "a.json"}]')
    scenario = load_scenario(file)
    assert (scenario.robots, scenario.graph) == (2, ((0, 1, 2.0),))
    assert [stage.row for stage in robot_view(scenario, 0).stages] == [((1, 0.5),), ((1, 2.0),)]


def test_range_limited_links_all_and_everyone_may_hear_everyone() -> None:
    scenario = load(topology="range-limited", graph_options__range=12)
    assert scenario.graph == build("all", 5).edges
    assert [(s.at, s.range) for s in scenario.schedule] == [(0.0, 12.0)]
    view = robot_view(scenario, 2)
    assert view.linked == (0, 1, 3, 4)
    assert view.max_degree == 4.0
    assert not view.complete, "positions have to be passed on"


def test_a_stage_of_a_fixed_size_decides_how_many_robots_there_are() -> None:
    assert load(topology=[{"at": 0, "name": "ring"}, {"at": 5, "name": "fig-5.3"}]).robots == 3
    assert robot_view(load(topology=[{"at": 0, "name": "all"}, {"at": 5, "name": "fig-5.18"}]), 0).complete


@pytest.mark.parametrize(
    ("topology", "sentence"),
    [
        ([], "topology is an empty list; write [[topology]] tables"),
        ({"at": 0, "name": "ring"}, "topology is a table; write [[topology]] tables"),
        ([3], "topology, entry 1 is 3; write [[topology]] tables"),
        ([{"at": 0}], "topology, entry 1: name is missing; write [[topology]] tables"),
        ([{"name": "ring"}], "topology, entry 1: at is missing; write"),
        ([{"at": 0, "nam": "ring"}], 'topology, entry 1: there is no value "nam"; did you mean "name"?'),
        ([{"at": -1, "name": "ring"}], "topology, entry 1: at is -1; it must be a number >= 0."),
        ([{"at": float("nan"), "name": "ring"}], "topology, entry 1: at is nan; it must be a number >= 0."),
        ([{"at": 1, "name": "ring"}], "topology, entry 1: at is 1; it must be 0"),
        ([*LINE_STAR, {"at": 10, "name": "ring"}], "topology, entry 3: at is 10; it must be greater than 10"),
        ([*LINE_STAR, {"at": 20, "name": "rign"}], 'there is no topology "rign"; did you mean "ring"?'),
        ([{"at": 0, "name": "ring", "range": 0 - 2.0}], "topology, entry 1: range is -2.0; it must be a number >= 0."),
        ([{"at": 0, "name": "fig-5.3"}, {"at": 5, "name": "fig-3.2"}], 'topology "fig-3.2" has 4 robots and robots is 3'),
        ([{"at": 0, "name": "x", "edges": [[0, 9, 1.0]]}], "the stage at 0 s: edge [0, 9] names robot 9"),
    ],
)
def test_a_bad_schedule_is_one_sentence(topology: object, sentence: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        load(topology=topology)
    assert str(caught.value).startswith(f"flag: {sentence}")
    assert "\n" not in str(caught.value)


def test_a_period_must_hold_all_stages() -> None:
    with pytest.raises(ScenarioError, match=r"graph_options\.period is 10; it must be greater than 10, when the last"):
        load(topology=LINE_STAR, graph_options__period=10)


def test_a_graph_and_a_schedule_are_not_both_given() -> None:
    with pytest.raises(ScenarioError, match=r"graph is given and topology is a schedule"):
        load(topology=LINE_STAR, graph=[[0, 1, 1.0]])


@pytest.mark.parametrize("topology", [LINE_STAR, "range-limited", "random", "k-nearest", "directed-ring",
                                      [{"at": 0, "name": "ring"}], [{"at": 0, "name": "ring", "range": 5}],
                                      [{"at": 0, "name": "line"}, {"at": 4, "name": "range-limited"}]])  # fmt: skip
def test_printing_and_reading_gives_the_same_scenario(topology: object, tmp_path: Path) -> None:
    scenario = load(topology=topology, seed=4, graph_options__period=30)
    (tmp_path / "s.toml").write_text(dump_toml(scenario))
    assert load_scenario(tmp_path / "s.toml") == scenario
    assert resolve(scenario) == scenario


starts = st.lists(st.integers(1, 400), unique=True, max_size=5).map(lambda ticks: [0, *sorted(ticks)])


@given(starts, st.integers(0, 300), st.integers(0, 4000), st.sampled_from([0.05, 0.1, 0.03, 1 / 3]))
def test_a_tick_belongs_to_the_last_stage_that_has_begun(ticks: list[int], rest: int, tick: int, dt: float) -> None:
    """Counted in whole ticks, against times that are rounded products."""
    period = ticks[-1] + rest if rest else 0
    now = tick % period if period else tick
    expected = max(n for n, start in enumerate(ticks) if start <= now)
    assert stage_at([k * dt for k in ticks], period * dt, tick * dt) == expected


def test_a_schedule_that_does_not_repeat_stays_at_its_last_stage() -> None:
    assert [stage_at([0.0, 10.0], 0.0, t) for t in (0.0, 9.99, 10.0, 1e5)] == [0, 0, 1, 1]
    assert [stage_at([0.0, 10.0], 20.0, t) for t in (0.0, 19.99, 20.0, 30.0)] == [0, 1, 0, 1]


def test_stages_made_in_code_are_filled_in() -> None:
    scenario = resolve(Scenario(schedule=(Stage(0.0, "line"), Stage(3.0, "all"))))
    assert [len(stage.edges) for stage in scenario.schedule] == [8, 20]
