"""Graphs: what they hold, the named ones, and the ones that a scenario refuses."""

from __future__ import annotations

import msgspec
import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.errors import ScenarioError
from protocol.scenario import Scenario
from protocol.scenario.load import load_scenario
from protocol.scenario.resolve import resolve
from protocol.topology.find import find_graph
from protocol.topology.graph import Graph, fault_in, make_graph
from protocol.topology.named import TOPOLOGIES, Topology, build

PAIRS = {
    ("all", 1): [],
    ("all", 3): [(0, 1), (0, 2), (1, 2)],
    ("ring", 1): [],
    ("ring", 2): [(0, 1)],
    ("ring", 3): [(0, 1), (0, 2), (1, 2)],
    ("ring", 4): [(0, 1), (0, 3), (1, 2), (2, 3)],
    ("line", 1): [],
    ("line", 2): [(0, 1)],
    ("line", 4): [(0, 1), (1, 2), (2, 3)],
    ("star", 1): [],
    ("star", 2): [(0, 1)],
    ("star", 4): [(0, 1), (0, 2), (0, 3)],
    ("fig-3.2", 4): [(0, 1), (0, 3), (1, 2), (2, 3)],
    ("fig-5.3", 3): [(0, 1), (1, 2)],
    ("fig-5.18", 3): [(0, 1), (0, 2), (1, 2)],
}


@pytest.mark.parametrize(("name", "robots"), PAIRS)
def test_a_named_topology_has_the_links_of_its_picture(name: str, robots: int) -> None:
    graph = build(name, robots)
    assert graph.robots == robots
    assert list(graph.links()) == PAIRS[name, robots]
    assert graph.is_symmetric()
    assert all(weight == 1.0 for _, _, weight in graph.edges)


@pytest.mark.parametrize("name", TOPOLOGIES)
@pytest.mark.parametrize("robots", [1, 2, 5, 12])
def test_every_named_topology_is_connected_and_free_of_faults(name: str, robots: int) -> None:
    graph = find_graph(name, robots)
    assert graph.robots == (TOPOLOGIES[name].robots or robots)
    assert fault_in(graph.robots, graph.edges) is None
    assert nx.is_strongly_connected(graph.to_networkx())


def test_a_new_topology_is_one_function_and_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    def couples(scenario: Scenario) -> list[tuple[int, int]]:
        return [(i, i + 1) for i in range(0, scenario.robots - 1, 2)]

    monkeypatch.setitem(TOPOLOGIES, "couples", Topology(couples, "two and two"))
    scenario = load_scenario(None, overrides=[("topology", "couples", "--topology"), ("robots", 4, "--robots")])
    assert scenario.graph == ((0, 1, 1.0), (1, 0, 1.0), (2, 3, 1.0), (3, 2, 1.0))
    with pytest.raises(ScenarioError, match=r'did you mean "couples"\?$'):
        find_graph("couple", 4)


@st.composite
def graphs(draw: st.DrawFn) -> Graph:
    n = draw(st.integers(1, 7))
    every = [(i, j) for i in range(n) for j in range(n) if i != j]
    chosen = draw(st.lists(st.sampled_from(every), unique=True)) if every else []
    weights = st.floats(0.01, 100)
    return make_graph(n, [(i, j, draw(weights)) for i, j in chosen])


@given(graphs(), st.randoms(use_true_random=False))
def test_relabelling_the_robots_relabels_the_graph(graph: Graph, random: object) -> None:
    new = list(range(graph.robots))
    random.shuffle(new)  # type: ignore[attr-defined]
    moved = make_graph(graph.robots, [(new[i], new[j], a) for i, j, a in graph.edges])
    for i in range(graph.robots):
        assert moved.neighbours(new[i]) == tuple(sorted(new[j] for j in graph.neighbours(i)))
        for j in range(graph.robots):
            assert moved.adjacency()[new[i]][new[j]] == graph.adjacency()[i][j]
    assert set(moved.links()) == {tuple(sorted((new[i], new[j]))) for i, j in graph.links()}
    assert moved.is_symmetric() == graph.is_symmetric()


@given(graphs())
def test_networkx_sees_the_same_graph(graph: Graph) -> None:
    theirs = graph.to_networkx()
    assert [list(row) for row in graph.adjacency()] == nx.to_numpy_array(theirs, range(graph.robots)).tolist()
    assert len(graph.links()) == theirs.to_undirected().number_of_edges()
    assert graph.is_symmetric() == all(
        theirs.get_edge_data(j, i, {}).get("weight") == data["weight"] for i, j, data in theirs.edges(data=True)
    )


@given(graphs())
def test_the_order_in_which_edges_are_given_does_not_matter(graph: Graph) -> None:
    assert make_graph(graph.robots, reversed(graph.edges)) == graph


@pytest.mark.parametrize(
    ("robots", "edges", "fault"),
    [
        (3, [(0, 3, 1.0)], "edge [0, 3] names robot 3; the robots must be numbered 0 to 2"),
        (3, [(-1, 0, 1.0)], "edge [-1, 0] names robot -1; the robots must be numbered 0 to 2"),
        (3, [(1, 1, 1.0)], "edge [1, 1] joins a robot to itself; an edge must join two robots"),
        (3, [(0, 1, -1.0)], "edge [0, 1] has weight -1; it must be a number > 0"),
        (3, [(0, 1, float("nan"))], "edge [0, 1] has weight nan; it must be a number > 0"),
        (3, [(0, 1, float("inf"))], "edge [0, 1] has weight inf; it must be a number > 0"),
        (3, [(0, 1, 1.0), (0, 1, 1.0)], "edge [0, 1] is given twice; every edge must be given once"),
        (0, [], "there are 0 robots; there must be 1 to 1000"),
    ],
)
def test_a_faulty_graph_says_which_edge_and_why(robots: int, edges: list[tuple[int, int, float]], fault: str) -> None:
    assert fault_in(robots, edges) == fault
    with pytest.raises(ScenarioError) as caught:
        make_graph(robots, edges)
    assert str(caught.value) == f"{fault}."


def test_an_undirected_edge_is_given_once() -> None:
    assert make_graph(2, [(1, 0, 0.5)], directed=False).edges == ((0, 1, 0.5), (1, 0, 0.5))
    with pytest.raises(ScenarioError, match=r"^edge \[1, 0\] is given twice; .* once, for both directions\.$"):
        make_graph(2, [(0, 1), (1, 0)], directed=False)


def test_resolving_keeps_a_graph_that_is_there() -> None:
    given_graph = msgspec.structs.replace(Scenario(), graph=((0, 1, 1.0),))
    assert resolve(given_graph) is given_graph


def test_resolving_a_scenario_made_in_code_fills_in_graph_and_robots() -> None:
    assert resolve(Scenario(topology="fig-5.3")).robots == 3
    assert resolve(Scenario(topology="line", robots=2)).graph == ((0, 1, 1.0), (1, 0, 1.0))
    with pytest.raises(ScenarioError, match="has 3 robots and robots is 4"):
        resolve(Scenario(topology="fig-5.3", robots=4))
    with pytest.raises(ScenarioError, match="has 3 robots and robots is 5"):
        resolve(Scenario(topology="fig-5.3", robots=5), robots_given=True)


def test_an_unknown_topology_with_nothing_near_lists_names_and_files() -> None:
    with pytest.raises(ScenarioError) as caught:
        find_graph("zzz", 3)
    for each in (*TOPOLOGIES, ".toml", ".graphml"):
        assert each in str(caught.value)
