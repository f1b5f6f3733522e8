"""plume-map: a map that is equal to the bit wherever the events are, and the posterior below a cell."""

from math import hypot, log

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plume_helpers import ARENA, TABLE, record
from scipy.interpolate import RectBivariateSpline

from protocol.scenario.check import HALVINGS
from protocol.scenario.sections import Arena
from robot_agent.interfaces import Posterior
from robot_agent.plume.events import LAGS, SIZE, pack, unpack
from robot_agent.plume.map import EventMap
from robot_agent.plume.moments import CUT
from robot_agent.plume.posterior import BODY, FAR, posterior, spread


def chart_of(events):
    chart = EventMap(ARENA, TABLE, 1.0)
    for k, bits in events:
        chart.learn(k, unpack(bits, ARENA))
    return chart


def cells(chart):
    return [*chart.fine.M, *chart.coarse.M]


speeds = st.floats(-4.0, 4.0)
events = st.tuples(
    st.integers(0, 400),
    st.builds(
        record,
        robot=st.integers(0, 9),
        hit=st.booleans(),
        x=st.floats(0.0, 100.0),
        y=st.floats(-50.0, 50.0),
        wind=st.tuples(speeds, speeds),
        D=st.floats(0.02, 5.0),
    ),
)


@settings(max_examples=15, deadline=None)
@given(st.lists(events, min_size=1, max_size=8), st.randoms(use_true_random=False))
def test_the_same_events_give_the_same_map_to_the_bit_in_any_order(told, random):
    in_order = chart_of(sorted(told))
    shuffled = list(told)
    random.shuffle(shuffled)
    chart = chart_of(shuffled)
    assert cells(chart) == cells(in_order)
    assert posterior(chart) == posterior(in_order)


@settings(max_examples=10, deadline=None)
@given(st.lists(events, min_size=1, max_size=4), st.lists(events, min_size=1, max_size=4))
def test_also_where_a_cell_is_more_than_doubles_tell_apart(early, late):
    """An event weighs twice as much as one a hundred decisions before."""
    told = [*early, *((k + 20_000, bits) for k, bits in late)]
    one, other = chart_of(told), chart_of(reversed(told))
    assert cells(one) == cells(other)
    assert posterior(one) == posterior(other)
    alone = [cells(chart_of([event])) for event in told]
    assert cells(one) == [sum(map(int, same)) for same in zip(*alone, strict=True)]


def test_an_event_that_comes_late_counts_as_if_it_had_come_in_time():
    early, late = (10, record(hit=True, y=3.0)), [(k, record(x=60.0 - k, y=1.0)) for k in range(11, 40)]
    assert cells(chart_of([early, *late])) == cells(chart_of([*late, early]))


@given(st.binary(min_size=SIZE, max_size=SIZE), st.integers(0, 50))
def test_any_bytes_are_some_event_and_the_map_takes_it(bits, k):
    chart = chart_of([(k, bits)])
    assert all(float(m).is_integer() for m in cells(chart))


def test_hits_and_misses_beside_each_other_say_where_the_plume_runs():
    chart = chart_of((k, record(hit=abs(y) < 1.0, y=y)) for k in range(5) for y in (-4.0, -2.0, 0.0, 2.0, 4.0))
    p = posterior(chart)
    assert abs(p.y) < 0.5  # a wide posterior is looked at in every second column only, and the middle is between two
    assert p.yy < 1.5
    assert p.x < 50.0  # upwind of the robots


def passes(sx, sy, turn, speed):
    """A line of five that goes back and forth over a source at (sx, sy) for two minutes."""
    told = []
    for k in range(120):
        ahead = abs((speed * k) % 26.0 - 13.0) - 6.5  # metres downwind of the source
        for robot, side in enumerate((-3.85, -1.85, 0.15, 2.15, 4.15)):
            x, y = sx + ahead * turn[0] - side * turn[1], sy + ahead * turn[1] + side * turn[0]
            told.append((k, record(robot, abs(side) < 0.9 and ahead > -0.65, x, y, wind=turn, D=0.05)))
    return told


@pytest.mark.parametrize(
    ("source", "off"),
    [((40.0, 3.0), 0.6), ((40.5, 3.25), 0.65), ((40.125, 2.875), 0.65), ((40.5, 2.875), 0.65)],
    ids=["anywhere", "corner", "middle", "edge"],
)
@pytest.mark.parametrize("speed", [0.71, 0.77, 0.83])
@pytest.mark.parametrize("turn", [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (0.7071, 0.7071), (-0.6, 0.8)])
def test_a_line_that_passes_the_source_back_and_forth_knows_it_below_the_size_of_a_cell(turn, speed, source, off):
    """Whatever way the wind blows, and wherever in its cell the source is. Hits weigh more than misses: it is placed some
    0.3 m upwind, more or less with where each pass meets it between two samples."""
    told = passes(*source, turn, speed)
    p = posterior(chart_of(told))
    assert hypot(p.x - source[0], p.y - source[1]) < off
    assert spread(p) < 0.7


@pytest.mark.parametrize("turn", [(1.0, 0.0), (-0.6, 0.8)])
def test_the_few_cells_that_are_looked_at_say_what_all_cells_say(turn):
    """Nearly so, where the spread is below 4 m: of a wider one a sample is looked at.

    Where about a fiftieth is far from the best cell, it may be counted or not.
    """
    chart = EventMap(ARENA, TABLE, 1.0)
    looked = 0
    for n, (k, bits) in enumerate(passes(40.3, 2.9, turn, 0.77)):
        chart.learn(k, unpack(bits, ARENA))
        if n % 5 == 4:
            p, q = posterior(chart), by_all_cells(chart)
            if spread(q) < 4.0:
                looked += 1
                others = [by_all_cells(chart, far) for far in (0.5 * FAR, 2.0 * FAR)]
                assert any(alike(p, q) for q in (q, *others))
    assert looked > 60


def alike(p, q):
    near = hypot(p.x - q.x, p.y - q.y) < 0.12 + 0.2 * spread(q)
    return near and spread(p) == pytest.approx(spread(q), rel=0.3, abs=0.05)


@pytest.mark.parametrize("y", [20.0, 20.75, 21.5, 22.25])
@pytest.mark.parametrize("turn", [(1.0, 0.0), (0.0, 1.0)], ids=["along x", "along y"])
def test_a_narrow_ridge_does_not_slip_through_between_samples(turn, y):
    """After two hits the rest of the arena counts, too: a ridge that samples miss would seem to lie nearer to its middle."""
    u, v = turn
    x0, y0 = (60.0, y) if u else (50.0 + y, 10.0)
    chart = chart_of((k, record(hit=True, x=x0, y=y0, wind=turn, D=0.02)) for k in range(2))
    p, q = posterior(chart), by_all_cells(chart)
    assert abs((p.y - q.y) * u - (p.x - q.x) * v) < 0.5


@pytest.mark.parametrize("high", [0, 1])
def test_two_narrow_tops_that_lie_between_samples_both_count(high):
    """One is looked for, and the box about it is to hold the other, too."""
    chart = EventMap(ARENA, TABLE, 1.0)
    tops = [(41, 80, high), (57, 81, 1 - high)]

    def height(i, j):
        return max(-2.0 * (i - u) ** 2 - 4.0 * (j - v) ** 2 - less for u, v, less in tops)

    chart.fine.M[:] = [round(height(i, j) / chart.scale()) for i in range(chart.nx) for j in range(chart.ny)]
    assert max(height(i, j) for i, js, _, _ in chart.sample() for j in js) < -2.0
    p, q = posterior(chart), by_all_cells(chart)
    assert spread(q) > 4.0
    assert (p.x, p.y) == pytest.approx((q.x, q.y), abs=0.5)
    assert spread(p) == pytest.approx(spread(q), rel=0.1)


@pytest.mark.parametrize("high", [3.0, 6.0, 9.0])
def test_a_narrow_top_that_samples_do_not_show_counts_beside_all_that_they_show(high):
    """Of a wide posterior samples tell; what is hidden between them may weigh as much, or more."""
    chart = EventMap(ARENA, TABLE, 1.0)

    def height(i, j):
        return max(-0.002 * (i - 80) ** 2 - 0.002 * (j - 30) ** 2, high - 4.0 * (i - 41) ** 2 - 4.0 * (j - 80) ** 2)

    chart.fine.M[:] = [round(height(i, j) / chart.scale()) for i in range(chart.nx) for j in range(chart.ny)]
    assert max(top for _, _, _, top in chart.sample()) * chart.scale() < 0.01
    p, q = posterior(chart), by_all_cells(chart)
    assert (p.x, p.y) == pytest.approx((q.x, q.y), abs=0.1 * spread(q))
    assert spread(p) == pytest.approx(spread(q), rel=0.15)


@pytest.mark.parametrize(("faint", "narrow"), [(0.01, True), (0.05, False)])
def test_a_faint_place_far_away_does_not_widen_the_posterior(faint, narrow):
    """A fiftieth of all: less does not count, more does."""
    chart = EventMap(ARENA, TABLE, 1.0)
    tops = [(41, 80, 0.0), (61, 81, -log(faint))]
    chart.fine.M[:] = [
        round(max(-0.5 * (i - u) ** 2 - 0.5 * (j - v) ** 2 - less for u, v, less in tops) / chart.scale())
        for i in range(chart.nx)
        for j in range(chart.ny)
    ]
    p, q = posterior(chart), by_all_cells(chart)
    assert (spread(p) < 1.4) == narrow
    assert (p.x, p.y) == pytest.approx((q.x, q.y), abs=0.1)
    assert spread(p) == pytest.approx(spread(q), rel=0.1)


def by_all_cells(chart, far=FAR):
    """Mean and covariance over parts of all fine cells, or of those near the best one if nearly all is there.

    With a spline through the middles of cells.
    """
    M = np.array(chart.window(range(chart.nx), range(chart.ny)), dtype=float) * chart.scale()
    u, v = np.arange(0.0, chart.nx - 1, 0.25), np.arange(0.0, chart.ny - 1, 0.25)
    w = RectBivariateSpline(np.arange(chart.nx), np.arange(chart.ny), M)(u, v)
    w = np.where(w > w.max() - CUT, np.exp(w - w.max()), 0.0)
    i, j = np.unravel_index(w.argmax(), w.shape)
    near = np.outer(abs(u - u[i]) <= BODY, abs(v - v[j]) <= BODY)
    if w[~near].sum() < far * w[near].sum():
        w = np.where(near, w, 0.0)
    w /= w.sum()
    x, y = chart.x0 + (u + 0.5) * chart.cell, chart.y0 + (v + 0.5) * chart.cell
    mx, my = w.sum(1) @ x, w.sum(0) @ y
    return Posterior(mx, my, w.sum(1) @ (x - mx) ** 2, (x - mx) @ w @ (y - my), w.sum(0) @ (y - my) ** 2)


def test_between_the_middles_of_coarse_cells_the_map_is_linear():
    chart = EventMap(ARENA, TABLE, 1.0)
    far = chart.coarse
    far.M[:] = [640 * a + 64 * b for a in range(far.nx) for b in range(far.ny)]
    inside = range(2, chart.nx - 2), range(2, chart.ny - 2)
    for i, row in zip(inside[0], chart.window(*inside), strict=True):
        assert row == [160 * i + 16 * j - 264 for j in inside[1]]
    corner = chart.window(range(0, 1), range(0, 1))
    assert corner == [[0]], "at the edge as the nearest coarse cell"


@pytest.mark.parametrize("length", [2.0, 40.0])
def test_an_arena_of_the_width_of_a_coarse_cell_will_do(length):
    chart = EventMap(Arena(x_min=0.0, x_max=2.0, y_min=20.0 - length / 2.0, y_max=20.0 + length / 2.0), TABLE, 1.0)
    for k in range(20):
        chart.learn(k, unpack(pack(0, k % 2 == 0, 1.0, 20.0, 0.1, [(0.0, lag) for lag in LAGS], ARENA), ARENA))
        assert 0.0 <= posterior(chart).x <= 3.0


def test_what_a_scenario_allows_a_map_can_hold():
    last = int(HALVINGS * TABLE.forget * log(2.0))
    told = [(k + 10 * n, record(hit=n % 2 == 0, y=1.0)) for k in (0, last - 100) for n in range(10)]
    assert posterior(chart_of(told)).y == pytest.approx(1.0, abs=0.5)


def test_far_events_are_forgotten():
    old = [(k, record(hit=True, y=20.0)) for k in range(20)]
    new = [(k, record(hit=True, y=-20.0)) for k in range(1000, 1020)]
    assert posterior(chart_of(old)).y == pytest.approx(20.0, abs=0.5)
    assert posterior(chart_of(old + new)).y == pytest.approx(-20.0, abs=0.5)
