"""Who may hear whom at a tick, against the obvious double loop."""

from __future__ import annotations

from math import hypot

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.scenario import Scenario
from protocol.scenario.load import load_scenario
from world_server.links import Links

NAMES = ["all", "ring", "line", "star", "directed-ring", "random"]
stage_lists = st.lists(
    st.tuples(st.integers(1, 200), st.sampled_from(NAMES), st.sampled_from([0.0, 3.0, 10.0])), min_size=1, max_size=4,
    unique_by=lambda stage: stage[0],
)  # fmt: skip
places = st.lists(st.tuples(st.floats(0, 20), st.floats(0, 20)), min_size=6, max_size=6)


def scheduled(stages: list[tuple[int, str, float]], period: float) -> Scenario:
    first, *rest = sorted(stages)
    tables = [{"at": 0, "name": first[1], "range": first[2]}]
    tables += [{"at": at * 0.05, "name": name, "range": reach} for at, name, reach in rest]
    values = {"robots": 6, "topology": tables, "graph_options.period": period}
    return load_scenario(None, overrides=[(name, value, "-") for name, value in values.items()])


@given(stage_lists, st.booleans(), st.integers(0, 1000), places)
def test_a_robot_hears_whom_the_stage_declares_within_the_range(
    stages: list[tuple[int, str, float]], again: bool, tick: int, at: list[tuple[float, float]]
) -> None:
    scenario = scheduled(stages, period=15.0 if again else 0.0)
    links = Links(scenario)
    hands = np.array(at)
    links.advance(tick, lambda: hands)
    now = tick % 300 if again else tick
    rules = [stage for stage in scenario.schedule if round(stage.at / 0.05) <= now][-1]
    for i in range(6):
        heard = []
        for j in range(6):
            declared = any((a, b) == (i, j) for a, b, _ in rules.edges)
            if declared and (not rules.range or hypot(at[i][0] - at[j][0], at[i][1] - at[j][1]) <= rules.range):
                heard.append(j)
        assert links.rows[i] == tuple(heard)


def test_what_is_open_follows_from_the_tick_alone_whatever_was_asked_before() -> None:
    scenario = scheduled([(1, "ring", 5.0), (100, "line", 0.0)], 8.0)
    rng = np.random.default_rng(1)
    walked, places_of = Links(scenario), [rng.uniform(0, 10, (6, 2)) for _ in range(300)]
    for tick in (*range(300), *range(299, -1, -7)):
        hands = places_of[tick]
        walked.advance(tick, lambda hands=hands: hands)
        fresh = Links(scenario)
        fresh.advance(tick, lambda hands=hands: hands)
        assert walked.rows == fresh.rows


@pytest.mark.parametrize("name", NAMES)
def test_a_graph_that_never_changes_asks_for_no_places_and_makes_nothing_new(name: str) -> None:
    scenario = load_scenario(None, overrides=[("topology", name, "-")])
    links = Links(scenario)
    before = links.rows

    def nobody_asks() -> np.ndarray:
        raise AssertionError

    links.advance(77, nobody_asks)
    assert links.rows is before
    assert before == [tuple(sorted(j for a, j, _ in scenario.graph if a == i)) for i in range(5)]
