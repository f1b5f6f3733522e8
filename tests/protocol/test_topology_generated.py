"""Topologies that are generated: repeatable, connected, with the degrees that were asked for."""

from __future__ import annotations

from itertools import pairwise
from math import dist

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.errors import ScenarioError
from protocol.scenario import Scenario
from protocol.scenario.graph_options import GraphOptions
from protocol.scenario.load import load_scenario
from protocol.scenario.sections import Start
from protocol.scenario.start import start_points
from protocol.topology.graph import Graph
from protocol.topology.named import build

sizes = st.integers(1, 24)
seeds = st.integers(0, 2**62)


def random_graph(robots: int, mean_degree: float = 2.5, *, run: int = 0, seed: int = -1) -> Graph:
    return build("random", robots, Scenario(seed=run, graph_options=GraphOptions(mean_degree=mean_degree, seed=seed)))


@given(sizes, st.floats(0, 30), seeds)
def test_a_random_graph_is_connected_and_has_the_links_that_were_asked_for(n: int, degree: float, seed: int) -> None:
    graph = random_graph(n, degree, run=seed)
    assert nx.is_connected(graph.to_networkx().to_undirected())
    assert graph.is_symmetric()
    assert len(graph.links()) == min(max(round(n * degree / 2), n - 1), n * (n - 1) // 2)


@given(st.integers(2, 16), seeds, st.floats(0, 8), st.floats(0, 8))
def test_who_asks_for_more_links_gets_the_same_ones_and_further_ones(n: int, seed: int, a: float, b: float) -> None:
    few, many = sorted((a, b))
    assert set(random_graph(n, few, run=seed).edges) <= set(random_graph(n, many, run=seed).edges)


def test_a_random_graph_follows_from_its_own_seed_or_else_from_that_of_the_run() -> None:
    by_run = [random_graph(8, run=run).edges for run in range(20)]
    assert len(set(by_run)) > 15
    assert by_run == [random_graph(8, run=run).edges for run in range(20)]
    assert {random_graph(8, run=run, seed=3).edges for run in range(20)} == {by_run[3]}


def test_random_trees_are_not_all_of_one_shape() -> None:
    largest = [max(len(random_graph(6, 0, run=run).neighbours(i)) for i in range(6)) for run in range(200)]
    assert {2, 3, 4, 5} >= set(largest) >= {2, 3, 4}


points = st.lists(st.tuples(st.floats(0, 100), st.floats(-50, 50)), min_size=2, max_size=9, unique=True)


@given(points, st.integers(1, 9))
def test_k_nearest_links_each_to_its_nearest_or_says_how_many_it_takes(
    places: list[tuple[float, float]], k: int
) -> None:
    n = len(places)

    def scenario(nearest: int) -> Scenario:
        options = GraphOptions(nearest=nearest)
        return Scenario(robots=n, start=Start(positions=tuple(places)), graph_options=options)

    try:
        graph = build("k-nearest", n, scenario(k))
    except ScenarioError as error:
        enough = int(str(error).rsplit("at least ", 1)[1].rstrip("."))
        assert k < enough < n
        build("k-nearest", n, scenario(enough))
        with pytest.raises(ScenarioError):
            build("k-nearest", n, scenario(enough - 1))
        return
    assert nx.is_connected(graph.to_networkx().to_undirected())
    for i in range(n):
        neighbours = graph.neighbours(i)
        assert len(neighbours) >= min(k, n - 1)
        others = sorted(dist(places[i], places[j]) for j in range(n) if j != i)
        near = [j for j in range(n) if j != i and dist(places[i], places[j]) < others[min(k, n - 1) - 1]]
        assert set(near) <= set(neighbours)


def test_k_nearest_of_the_column_links_each_to_the_next_two() -> None:
    graph = build("k-nearest", 5)
    assert graph.links() == ((0, 1), (0, 2), (1, 2), (2, 3), (2, 4), (3, 4))
    assert all(abs(b[1] - a[1] - 3.0) < 1e-12 for a, b in pairwise(start_points(Scenario())))


def test_k_nearest_that_falls_apart_is_refused_with_what_would_do() -> None:
    values = {"robots": 4, "topology": "k-nearest", "graph_options.nearest": 1}
    places = [[90, -40], [90, -39], [90, 10], [90, 11]]
    overrides = [(name, value, "my.toml") for name, value in {**values, "start.positions": places}.items()]
    with pytest.raises(ScenarioError) as caught:
        load_scenario(None, overrides=overrides)
    assert str(caught.value) == (
        'my.toml: topology "k-nearest" with graph_options.nearest = 1 falls apart where the robots start; it must be at'
        " least 2."
    )


def test_k_nearest_needs_a_place_for_every_robot() -> None:
    values = {"robots": 4, "topology": "k-nearest", "start.positions": [[90, -40], [90, -30]]}
    with pytest.raises(ScenarioError, match=r"has 2 points and robots is 4; k-nearest needs one per robot\.$"):
        load_scenario(None, overrides=[(name, value, "-") for name, value in values.items()])


@given(st.integers(2, 12))
def test_in_a_directed_ring_each_listens_to_the_one_before_it(n: int) -> None:
    graph = build("directed-ring", n)
    assert [graph.neighbours(i) for i in range(n)] == [((i - 1) % n,) for i in range(n)]
    assert nx.is_strongly_connected(graph.to_networkx())
