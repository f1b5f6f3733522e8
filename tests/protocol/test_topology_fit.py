"""Whether gains fit a graph: condition (5.2) in words, and for directed graphs the roots themselves."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from protocol.topology.analysis import analyse
from protocol.topology.fit import fit_warning, least_gamma
from protocol.topology.graph import Graph, make_graph
from protocol.topology.named import build


@st.composite
def directed_graphs(draw) -> Graph:
    n = draw(st.integers(2, 5))
    pairs = [(i, j) for i in range(n) for j in range(n) if i != j]
    return make_graph(n, draw(st.lists(st.sampled_from(pairs), unique=True, min_size=1)))


@given(directed_graphs(), st.floats(0.1, 3.0), st.floats(0.05, 3.0))
@settings(max_examples=80, deadline=None)
def test_gamma_beyond_the_least_one_is_what_makes_all_roots_stable(graph, beta, gamma):
    analysis = analyse(graph)
    assume(analysis.spanning_tree)
    least = least_gamma(analysis, beta)
    assume(abs(gamma - least) > 1e-3)
    roots = [root for mu in analysis.nonzero for root in np.roots([1.0, gamma * mu, beta * mu])]
    assert (max(root.real for root in roots) < 0) == (gamma > least)


def test_gains_that_fit_are_not_worth_a_word():
    assert fit_warning(analyse(build("fig-5.3", 3)), 0.5, 0.9, "drill") is None
    assert fit_warning(analyse(build("line", 1)), 0.5, 0.9, "drill") is None


def test_a_warning_names_the_eigenvalue_and_the_gamma_that_is_needed():
    sentence = fit_warning(analyse(build("line", 5)), 0.5, 1.2, "drill")
    assert sentence is not None
    assert "mu = 0.382" in sentence
    assert "drill.gamma > 1.322, and it is 1.2" in sentence


@pytest.mark.parametrize(("gamma", "verdict"), [(0.3, "that holds"), (0.28, "that fails")])
def test_for_a_directed_graph_it_says_what_is_checked(gamma, verdict):
    cycle = make_graph(3, [(0, 1), (1, 2), (2, 0)])
    sentence = fit_warning(analyse(cycle), 0.5, gamma, "dcs")
    assert sentence is not None
    assert "condition (5.2) is about undirected ones" in sentence
    assert "dcs.gamma > 0.2887" in sentence
    assert verdict in sentence


def test_graphs_on_which_nobody_can_agree_are_called_so():
    apart = make_graph(4, [(0, 1), (2, 3)], directed=False)
    two_leaders = make_graph(3, [(1, 0), (1, 2)])
    assert "not connected" in str(fit_warning(analyse(apart), 0.5, 2.0, "dcs"))
    assert "no spanning tree" in str(fit_warning(analyse(two_leaders), 0.5, 2.0, "dcs"))
