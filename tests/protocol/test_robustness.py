"""Robustness of graphs against liars: the definition itself as oracle, and what is known of complete graphs."""

from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol.topology.graph import make_graph
from protocol.topology.named import build
from protocol.topology.robustness import MOST, Robustness, largest_s, robustness


def is_robust(graph, r, s):
    """Definition 15 of LeBlanc et al., pair by pair."""

    def reached(nodes):
        return sum(sum(j not in nodes for j in graph.neighbours(i)) >= r for i in nodes)

    for sides in product((0, 1, 2), repeat=graph.robots):
        one, two = ({i for i, side in enumerate(sides) if side == which} for which in (1, 2))
        if one and two:
            x1, x2 = reached(one), reached(two)
            if x1 < len(one) and x2 < len(two) and x1 + x2 < s:
                return False
    return True


edges = st.sets(st.tuples(st.integers(0, 4), st.integers(0, 4)).filter(lambda e: e[0] != e[1]))


@given(edges=edges, r=st.integers(1, 3))
@settings(max_examples=40, deadline=None)
def test_largest_s_is_the_definitions_for_any_directed_graph(edges, r):
    graph = make_graph(5, sorted(edges))
    most = largest_s(graph, r)
    assert [is_robust(graph, r, s) for s in range(1, 6)] == [s <= most for s in range(1, 6)]


@pytest.mark.parametrize("n", range(2, 11))
def test_a_complete_graph_is_half_as_robust_as_it_is_large_and_withstands_a_minority(n):
    assert robustness(build("all", n)) == Robustness(r=(n + 1) // 2, liars=(n - 1) // 2)


@pytest.mark.parametrize("name", ["ring", "line", "star"])
def test_sparse_graphs_withstand_nobody(name):
    assert robustness(build(name, 6)) == Robustness(r=1, liars=0)


def test_a_graph_in_two_parts_is_not_robust_at_all():
    assert robustness(make_graph(4, [(0, 1), (2, 3)], directed=False)) == Robustness(r=0, liars=0)


def test_large_graphs_are_not_looked_into():
    assert robustness(build("ring", MOST + 1)) is None
