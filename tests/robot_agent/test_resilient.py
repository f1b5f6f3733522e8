"""The fusion among liars: invariants, a liar of every kind, and what it is without one."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol.scenario.sections import Fusion
from protocol.topology.graph import make_graph
from protocol.topology.named import build
from protocol.topology.robustness import robustness
from robot_agent import fusion
from robot_agent.resilient import centred, trimmed

DT = 0.05
numbers = st.floats(-50, 50)
points = st.tuples(numbers, numbers)


def run(graph, starts, lies, ticks, parameters, inputs=None):
    """States of the honest robots after `ticks`; `lies`: robot -> what it says at tick k to whom."""
    rows = [[(j, a) for k, j, a in graph.edges if k == i] for i in range(graph.robots)]
    degree = max(sum(a for _, a in row) for row in rows)
    ys = dict(enumerate(starts))
    for k in range(ticks):
        ys = {
            i: fusion.step(
                ys[i],
                [(a, *(lies[j](k, i) if j in lies else ys[j])) for j, a in rows[i]],
                inputs[i] if inputs else None,
                parameters,
                degree,
                DT,
            )
            for i in ys
        }
    return [ys[i] for i in ys if i not in lies]


LIES = {
    "far": lambda k, i: (500.0, -500.0),
    "to and fro": lambda k, i: (500.0, 500.0) if k % 2 else (-500.0, -500.0),
    "drifting": lambda k, i: (0.5 * DT * k, -0.5 * DT * k),
    "two-faced": lambda k, i: (100.0 * (i - 2), 40.0 * (2 - i)),
    "nearly true": lambda k, i: (60.0, 3.0),
}


def spread(points):
    return max(max(axis) - min(axis) for axis in zip(*points, strict=True))


@pytest.mark.parametrize("kind", LIES)
@pytest.mark.parametrize("which", ["trimmed", "median"])
@given(starts=st.lists(points, min_size=5, max_size=5), liar=st.integers(0, 4))
@settings(max_examples=8, deadline=None)
def test_five_robots_with_one_liar_agree_within_the_hull_of_the_honest(kind, which, starts, liar):
    honest = [y for i, y in enumerate(starts) if i != liar]
    parameters = Fusion(kind="resilient", filter=which)
    ends = run(build("all", 5), starts, {liar: LIES[kind]}, 400, parameters)
    for axis in (0, 1):
        low, high = min(y[axis] for y in honest), max(y[axis] for y in honest)
        assert all(low - 1e-9 <= y[axis] <= high + 1e-9 for y in ends)
    if which == "trimmed":
        assert spread(ends) < 1e-3


def test_the_plain_fusion_is_pulled_away_by_the_same_liar():
    starts = [(30.0, 0.0)] * 5
    assert run(build("all", 5), starts, {4: LIES["far"]}, 400, Fusion())[0][0] > 400.0


def test_with_inputs_the_resilient_fusion_stays_at_them_and_the_plain_one_goes_with_the_liar():
    starts = inputs = [(28.0, 0.0), (29.0, 1.0), (31.0, -1.0), (32.0, 0.0), (30.0, 0.0)]
    lie = {4: lambda k, i: (95.0, 45.0)}
    for which in ("trimmed", "median"):
        ends = run(build("all", 5), starts, lie, 600, Fusion(kind="resilient", filter=which), inputs)
        assert all(28.0 <= x <= 32.0 and -1.0 <= y <= 1.0 for x, y in ends)
    assert run(build("all", 5), starts, lie, 600, Fusion(), inputs)[0][0] > 50.0


def test_a_graph_that_is_robust_enough_need_not_be_complete():
    """Six robots, each listening to four others."""
    graph = make_graph(6, [(i, (i + d) % 6) for i in range(6) for d in (1, 2, 4, 5)])
    assert robustness(graph).liars >= 1
    starts = [(5.0 * i, -i) for i in range(6)]
    ends = run(graph, starts, {3: LIES["far"]}, 800, Fusion(kind="resilient"))
    assert spread(ends) < 1e-3
    assert all(0.0 <= x <= 25.0 for x, _ in ends)


def test_on_a_ring_the_trimmed_fusion_does_not_agree_even_without_a_liar():
    """Each robot takes away both neighbours when one is above it and one below: a ring is only 1-robust."""
    starts = [(10.0 * i, 0.0) for i in range(5)]
    assert spread(run(build("ring", 5), starts, {}, 800, Fusion(kind="resilient"))) > 1.0
    assert spread(run(build("ring", 5), starts, {}, 800, Fusion())) < 1e-3


@given(y=numbers, others=st.lists(st.tuples(st.floats(0.1, 3), numbers), max_size=6))
def test_without_liars_to_expect_nothing_is_taken_away(y, others):
    assert sorted(trimmed(y, others, 0)) == sorted(v for v in others if v[1] != y)


@given(y=numbers, others=st.lists(st.tuples(st.just(1.0), numbers), min_size=1, max_size=6), liars=st.integers(0, 3))
def test_no_more_than_the_extremes_are_taken_away_and_the_filters_mirror(y, others, liars):
    kept = trimmed(y, others, liars)
    assert sum(v > y for _, v in kept) == max(0, sum(v > y for _, v in others) - liars)
    assert sum(v < y for _, v in kept) == max(0, sum(v < y for _, v in others) - liars)
    mirrored = [(a, -v) for a, v in others]
    assert sorted(-v for _, v in trimmed(-y, mirrored, liars)) == sorted(v for _, v in kept)
    assert [-v for _, v in centred(-y, mirrored, liars)] == [v for _, v in centred(y, others, liars)]


@given(y=points, others=st.lists(st.tuples(st.floats(0.1, 3), numbers, numbers), max_size=5))
def test_plain_and_resilient_with_no_liar_to_expect_are_the_same_law(y, others):
    plain = fusion.step(y, others, (1.0, 2.0), Fusion(), 15.0, DT)
    resilient = fusion.step(y, others, (1.0, 2.0), Fusion(kind="resilient", liars=0), 15.0, DT)
    assert resilient == pytest.approx(plain, abs=1e-9)
