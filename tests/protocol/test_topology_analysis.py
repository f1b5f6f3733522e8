"""What the Laplacian says, against closed forms and slow, obvious second answers."""

from __future__ import annotations

from math import cos, inf, nextafter, pi, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.topology.analysis import analyse, gain_condition, laplacian
from protocol.topology.graph import Graph, make_graph
from protocol.topology.named import build

CLOSED_FORMS = {
    "line": lambda n: [2 - 2 * cos(pi * k / n) for k in range(n)],
    "ring": lambda n: [2 - 2 * cos(2 * pi * k / n) for k in range(n)],
    "all": lambda n: [0] + [n] * (n - 1),
    "star": lambda n: [0] + [1] * (n - 2) + [n],
}


@pytest.mark.parametrize("name", CLOSED_FORMS)
@pytest.mark.parametrize("robots", [3, 4, 5, 8, 13, 40])
def test_eigenvalues_equal_the_closed_form(name: str, robots: int) -> None:
    analysis = analyse(build(name, robots))
    expected = sorted(CLOSED_FORMS[name](robots))
    assert [value.real for value in analysis.eigenvalues] == pytest.approx(expected, abs=1e-9)
    assert all(value.imag == 0 for value in analysis.eigenvalues)
    assert analysis.lambda_2 == pytest.approx(expected[1], abs=1e-9)
    assert (analysis.zeros, analysis.connected, analysis.spanning_tree, analysis.directed) == (1, True, True, False)


def test_a_directed_ring_has_the_roots_of_unity_around_1() -> None:
    analysis = analyse(make_graph(5, [(i, (i + 1) % 5) for i in range(5)]))
    expected = sorted(
        (1 - np.exp(2j * pi * k / 5) for k in range(5)), key=lambda value: (round(value.real, 9), value.imag)
    )
    assert analysis.eigenvalues == pytest.approx(expected, abs=1e-9)
    assert analysis.directed
    assert analysis.spanning_tree


@st.composite
def graphs(draw: st.DrawFn) -> Graph:
    n = draw(st.integers(1, 6))
    every = [(i, j) for i in range(n) for j in range(n) if i != j]
    chosen = draw(st.lists(st.sampled_from(every), unique=True)) if every else []
    weights = st.floats(0.1, 10)
    return make_graph(n, [(i, j, draw(weights)) for i, j in chosen])


@given(graphs())
def test_the_rows_of_the_laplacian_add_up_to_zero(graph: Graph) -> None:
    ell = laplacian(graph)
    assert np.allclose(ell.sum(axis=1), 0.0, atol=1e-12)
    assert (ell - np.diag(np.diag(ell)) <= 0.0).all()


@given(graphs(), st.randoms(use_true_random=False))
def test_relabelling_the_robots_changes_nothing_of_the_analysis(graph: Graph, random: object) -> None:
    new = list(range(graph.robots))
    random.shuffle(new)  # type: ignore[attr-defined]
    mine = analyse(graph)
    theirs = analyse(make_graph(graph.robots, [(new[i], new[j], a) for i, j, a in graph.edges]))
    assert (mine.zeros, mine.connected, mine.spanning_tree, mine.directed) == (
        theirs.zeros,
        theirs.connected,
        theirs.spanning_tree,
        theirs.directed,
    )
    # Power sums, because a defective eigenvalue by itself moves by a root of the rounding error.
    for power in (1, 2, 3):
        mine_sum, their_sum = (sum(v**power for v in each.eigenvalues) for each in (mine, theirs))
        assert their_sum == pytest.approx(mine_sum, rel=1e-9, abs=1e-9)
    assert sum(v.real for v in mine.eigenvalues) == pytest.approx(np.trace(laplacian(graph)), abs=1e-9)


def reached_from(graph: Graph, speaker: int) -> set[int]:
    """Robots that hear of `speaker`, over others too."""
    heard = {speaker}
    for _ in range(graph.robots):
        heard |= {i for i, j, _ in graph.edges if j in heard}
    return heard


@given(graphs())
def test_a_spanning_tree_is_a_robot_that_all_hear_of(graph: Graph) -> None:
    everyone = set(range(graph.robots))
    assert analyse(graph).spanning_tree == any(reached_from(graph, i) == everyone for i in everyone)


@given(graphs())
def test_the_zeros_that_are_counted_on_the_graph_are_the_zeros_of_the_laplacian(graph: Graph) -> None:
    rank = np.linalg.matrix_rank(laplacian(graph), tol=1e-9)
    analysis = analyse(graph)
    assert analysis.zeros == graph.robots - rank  # Lemma 2: one zero when there is a spanning tree
    assert (analysis.zeros == 1) == analysis.spanning_tree
    assert all(value.real > 1e-6 for value in analysis.nonzero)


@given(graphs())
def test_information_spreads_over_links_when_all_listen_both_ways(graph: Graph) -> None:
    both = make_graph(graph.robots, [(i, j) for i, j in graph.links()], directed=False)
    analysis = analyse(both)
    assert analysis.connected == analysis.spanning_tree == analyse(graph).connected


def test_5_2_holds_only_just_for_the_gains_and_the_line_of_figure_5_3() -> None:
    analysis = analyse(build("fig-5.3", 3))
    assert [value.real for value in analysis.nonzero] == pytest.approx([1.0, 3.0])
    condition = gain_condition(analysis, beta=0.5, gamma=0.9)
    assert condition.bound == pytest.approx(sqrt(4 * 0.5 / 3))  # 0.816
    assert condition.holds
    assert not gain_condition(analysis, beta=0.5, gamma=0.81).holds
    assert not gain_condition(analyse(build("line", 4)), beta=0.5, gamma=0.9).holds


@given(graphs(), st.floats(0.01, 10))
def test_the_bound_of_5_2_is_the_smallest_gain_that_does(graph: Graph, beta: float) -> None:
    analysis = analyse(make_graph(graph.robots, graph.links(), directed=False))
    bound = gain_condition(analysis, beta, 1.0).bound
    slow = max((sqrt(4 * beta / (3 * value.real)) for value in analysis.nonzero), default=0.0)
    assert bound == slow
    assert not gain_condition(analysis, beta, bound).holds
    assert gain_condition(analysis, beta, nextafter(bound, inf)).holds == analysis.connected


def test_5_2_holds_for_no_directed_and_for_no_split_graph() -> None:
    directed = analyse(make_graph(3, [(0, 1), (1, 2), (2, 0)]))
    split = analyse(make_graph(4, [(0, 1), (2, 3)], directed=False))
    assert (split.zeros, split.lambda_2, split.connected, split.spanning_tree) == (2, 0.0, False, False)
    for analysis in (directed, split):
        condition = gain_condition(analysis, 0.5, 1e6)
        assert 0 < condition.bound < 1e6
        assert not condition.holds


def test_one_robot_agrees_with_itself_whatever_the_gains() -> None:
    analysis = analyse(build("all", 1))
    assert (analysis.eigenvalues, analysis.lambda_2) == ((0j,), None)
    assert gain_condition(analysis, 1e9, 1e-9).holds
