"""plume-map: events and their flood, a map that is equal to the bit, the posterior below a cell."""

from math import hypot

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from judging_helpers import reading, view
from scipy.interpolate import RectBivariateSpline

from protocol.scenario.laws import PlumeMap
from protocol.scenario.sections import Arena
from robot_agent.decision.plume_map import PlumeMapDecision
from robot_agent.hand import Own
from robot_agent.interfaces import Posterior
from robot_agent.plume.backtrace import WindPast
from robot_agent.plume.events import LAGS, SIZE, pack, unpack
from robot_agent.plume.evidence import Evidence
from robot_agent.plume.flood import Flood
from robot_agent.plume.map import EventMap
from robot_agent.plume.posterior import CUT, posterior, spread

ARENA = Arena()
TABLE = PlumeMap()


def record(robot=0, hit=False, x=50.0, y=0.0, wind=(1.0, 0.0), D=0.1):
    return pack(robot, hit, x, y, D, [(lag * wind[0], lag * wind[1]) for lag in LAGS], ARENA)


def chart_of(events):
    chart = EventMap(ARENA, TABLE, 1.0)
    for k, bits in events:
        chart.learn(k, unpack(bits, ARENA))
    return chart


def cells(chart):
    return [*chart.fine.M, *chart.coarse.M]


speeds = st.floats(-4.0, 4.0)
bends = st.floats(-2.0, 2.0)
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


def test_an_event_that_comes_late_counts_as_if_it_had_come_in_time():
    early, late = (10, record(hit=True, y=3.0)), [(k, record(x=60.0 - k, y=1.0)) for k in range(11, 40)]
    assert cells(chart_of([early, *late])) == cells(chart_of([*late, early]))


@given(
    st.floats(-10.0, 110.0), st.floats(-60.0, 60.0), st.floats(0.01, 10.0), st.booleans(), st.floats(-8.0, 8.0),
    st.floats(-8.0, 8.0), st.lists(st.tuples(bends, bends), min_size=len(LAGS) - 1, max_size=len(LAGS) - 1),
)  # fmt: skip
def test_a_record_says_where_the_air_was_within_a_part_of_what_is_known_of_it(x, y, D, hit, u, v, turns):
    """The wind of the first stretch is any; the others end within two deviations of where the mean wind leads."""
    wx, wy, before = LAGS[0] * u, LAGS[0] * v, LAGS[0]
    way = [(wx, wy)]
    for (p, q), lag in zip(turns, LAGS[1:], strict=True):
        sigma = (0.49 + D * lag) ** 0.5
        wx, wy, before = wx * lag / before + p * sigma, wy * lag / before + q * sigma, lag
        way.append((wx, wy))
    bits = pack(7, hit, x, y, D, way, ARENA)
    event = unpack(bits, ARENA)
    assert len(bits) == SIZE
    assert (event.robot, event.hit) == (7, hit)
    assert hypot(event.x - x, event.y - y) < 0.024
    assert event.D == pytest.approx(D, rel=0.031)
    (_, _, _), (lag, bx, by), *rest = event.way
    assert hypot(event.x - bx - way[0][0], event.y - by - way[0][1]) < 0.01 + 0.06 * hypot(*way[0])
    # Half a step of the latest stretch, and no more: rounding does not add up. Steps widen with the bend.
    error = hypot(event.x - bx - way[0][0], event.y - by - way[0][1])
    for (lag, bx, by), (dx, dy) in zip(rest, way[1:], strict=True):
        sigma = (0.49 + event.D * lag) ** 0.5
        error = hypot(event.x - bx - dx, event.y - by - dy)
        assert error < 0.48 * 1.42 * sigma


def test_a_way_that_hardly_bends_is_told_to_a_tenth_of_its_deviation():
    for n in range(100):
        u, v = 1.0 + 0.003 * n, 0.2 - 0.004 * n
        way = [(lag * u, lag * v + 0.001 * lag * (n % 7)) for lag in LAGS]
        event = unpack(pack(0, False, 50.0, 0.0, 0.05, way, ARENA), ARENA)
        for (lag, bx, by), (dx, dy) in zip(event.way[1:], way, strict=True):
            assert hypot(event.x - bx - dx, event.y - by - dy) < 0.15 * (0.49 + 0.05 * lag) ** 0.5


def test_when_the_wind_has_just_turned_the_way_is_still_told():
    """Its deviation has grown with the turn: so have the steps."""
    past = WindPast(TABLE, 1.0)
    past.prefill([(-1.0, 0.3)] * 105 + [(1.0, 0.3)] * 5)
    way, D = past.way(), past.diffusivity()
    event = unpack(pack(0, False, 50.0, 0.0, D, way, ARENA), ARENA)
    for (lag, bx, by), (dx, dy) in zip(event.way[1:], way, strict=True):
        assert hypot(event.x - bx - dx, event.y - by - dy) < 0.7 * (0.49 + event.D * lag) ** 0.5


@given(st.binary(min_size=SIZE, max_size=SIZE), st.integers(0, 50))
def test_any_bytes_are_some_event_and_the_map_takes_it(bits, k):
    chart = chart_of([(k, bits)])
    assert all(isinstance(m, int) for m in cells(chart))


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


@pytest.mark.parametrize("source", [(40.5, 3.25), (40.125, 2.875), (40.5, 2.875)], ids=["corner", "middle", "edge"])
@pytest.mark.parametrize("speed", [0.71, 0.77, 0.83])
@pytest.mark.parametrize("turn", [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (0.7071, 0.7071), (-0.6, 0.8)])
def test_a_line_that_passes_the_source_back_and_forth_knows_it_below_the_size_of_a_cell(turn, speed, source):
    """Whatever way the wind blows, and wherever in its cell the source is. Hits weigh more than misses: it is placed some
    0.3 m upwind, more or less with where each pass meets it between two samples."""
    told = passes(*source, turn, speed)
    p = posterior(chart_of(told))
    assert hypot(p.x - source[0], p.y - source[1]) < 0.65
    assert spread(p) < 0.7


@pytest.mark.parametrize("turn", [(1.0, 0.0), (-0.6, 0.8)])
def test_the_few_cells_that_are_looked_at_say_what_all_cells_say(turn):
    """Nearly so, where the spread is below 4 m: of a wider one a sample is looked at."""
    chart = EventMap(ARENA, TABLE, 1.0)
    looked = 0
    for n, (k, bits) in enumerate(passes(40.3, 2.9, turn, 0.77)):
        chart.learn(k, unpack(bits, ARENA))
        if n % 5 == 4:
            p, q = posterior(chart), by_all_cells(chart)
            if spread(q) < 4.0:
                looked += 1
                assert hypot(p.x - q.x, p.y - q.y) < 0.05 + 0.2 * spread(q)
                assert spread(p) == pytest.approx(spread(q), rel=0.3, abs=0.05)
    assert looked > 60


def by_all_cells(chart):
    """Mean and covariance over parts of all fine cells, with a spline through their middles."""
    M = np.array(chart.window(range(chart.nx), range(chart.ny)), dtype=float) * chart.scale()
    u, v = np.arange(0.0, chart.nx - 1, 0.25), np.arange(0.0, chart.ny - 1, 0.25)
    w = RectBivariateSpline(np.arange(chart.nx), np.arange(chart.ny), M)(u, v)
    w = np.where(w > w.max() - CUT, np.exp(w - w.max()), 0.0)
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


def test_an_arena_of_one_coarse_cell_will_do():
    chart = EventMap(Arena(x_min=0.0, x_max=2.0, y_min=0.0, y_max=40.0), TABLE, 1.0)
    for k in range(20):
        chart.learn(k, unpack(pack(0, k % 2 == 0, 1.0, 20.0, 0.1, [(0.0, lag) for lag in LAGS], ARENA), ARENA))
        assert 0.0 <= posterior(chart).x <= 3.0


def test_far_events_are_forgotten():
    old = [(k, record(hit=True, y=20.0)) for k in range(20)]
    new = [(k, record(hit=True, y=-20.0)) for k in range(1000, 1020)]
    assert posterior(chart_of(old)).y == pytest.approx(20.0, abs=0.5)
    assert posterior(chart_of(old + new)).y == pytest.approx(-20.0, abs=0.5)


def test_without_wind_history_the_way_goes_on_at_the_mean_wind():
    past = WindPast(TABLE, 1.0)
    past.record((1.0, 0.5))
    past.record((2.0, 0.5))
    assert past.way()[0] == (3.0, 1.0)
    assert past.way()[-1] == pytest.approx((110 * 1.5, 110 * 0.5))


# The flood -----------------------------------------------------------------------------------------------------------

GRAPHS = {
    "line": [(i, j) for i in range(4) for j in range(4) if abs(i - j) == 1],
    "ring": [(i, j) for i in range(4) for j in range(4) if abs(i - j) in (1, 3)],
    "directed ring": [((i + 1) % 4, i) for i in range(4)],
    "all": [(i, j) for i in range(4) for j in range(4) if i != j],
}


class Wires:
    """Four robots that flood, stepped by hand; `edges` (i, j): i hears j."""

    def __init__(self, edges, window=12):
        self.edges = edges
        self.robots = [Flood(4, window, [j for a, j in edges if a == i], [a for a, j in edges if j == i]) for i in range(4)]
        self.sets = [set() for _ in range(4)]
        self.sent = 0

    def second(self, k, keep=lambda i, j: True, ticks=8, mute=()):
        for i, robot in enumerate(self.robots):
            robot.clock(k)
            if i not in mute:
                assert robot.add((k, i), record(i))
                self.sets[i].add((k, i))
        for tick in range(ticks):
            told = [robot.tell(tick == 0) for robot in self.robots]
            self.sent += sum(map(len, told))
            for i, j in self.edges:
                if told[j] and keep(i, j):
                    for _ in range(2):  # twice is once
                        self.sets[i] |= {key for key, _ in self.robots[i].hear(j, told[j])}


@pytest.mark.parametrize("graph", GRAPHS)
def test_everybody_knows_every_event_after_as_many_ticks_as_the_graph_is_wide(graph):
    wires = Wires(GRAPHS[graph])
    wires.second(0)
    wires.second(1)
    assert all(known == {(k, i) for k in (0, 1) for i in range(4)} for known in wires.sets)


@settings(max_examples=20, deadline=None)
@given(st.sampled_from(sorted(GRAPHS)), st.randoms(use_true_random=False))
def test_loss_only_delays(graph, random):
    wires = Wires(GRAPHS[graph])
    for k in range(4):
        wires.second(k, keep=lambda i, j: random.random() < 0.7)
    for k in range(4, 13):
        wires.second(k, mute=range(4))
    assert all(known == {(k, i) for k in range(4) for i in range(4)} for known in wires.sets)


def test_a_line_of_which_half_the_edges_work_at_a_time_is_enough():
    wires = Wires(GRAPHS["line"])
    for k in range(10):
        wires.second(k, keep=lambda i, j, k=k: (min(i, j) + k) % 2 == 0, mute=range(4) if k else ())
    assert all(known == {(0, i) for i in range(4)} for known in wires.sets)


def test_a_robot_that_joins_late_is_told_the_window():
    wires = Wires(GRAPHS["line"])
    for k in range(5):
        wires.second(k, keep=lambda i, j: 3 not in (i, j))
    wires.second(5)
    wires.second(6)
    assert wires.sets[3] >= {(k, i) for k in range(5) for i in range(4)}


def test_robots_that_all_hear_each_other_send_an_event_once():
    wires = Wires(GRAPHS["all"])
    for k in range(20):
        wires.second(k)
    assert wires.sent / 20 / 4 < 20  # bytes a robot and second


@given(st.binary(max_size=200))
def test_foreign_bytes_never_raise_and_leave_no_robot_that_is_not_there(message):
    flood = Flood(4, 12, [1], [1])
    flood.clock(3)
    for key, bits in flood.hear(1, message):
        assert key[1] < 4
        assert len(bits) == SIZE
    flood.tell(True)


def test_in_real_time_a_decision_whose_tick_was_missed_tells_its_event_and_what_it_has():
    """At the first tick after it: a bitmap that waited for the very tick would not be told for as long as that is missed."""
    scenario = view(algorithm="plume-map", topology="line")
    decision = PlumeMapDecision(scenario)
    first = Own(reading(0), scenario.body)
    decision.record(first)
    assert decision.events(first)
    late = Own(reading(22), scenario.body, 18)
    decision.record(late)
    told = decision.events(late)
    assert told[2] > 0  # what it has follows
    assert not decision.events(Own(reading(23), scenario.body, 22))


def test_an_own_position_after_a_hang_is_the_reading_and_not_what_the_wheels_would_have_made_of_it():
    scenario = view(algorithm="plume-map", topology="line")
    decision = PlumeMapDecision(scenario)
    decision.record(Own(reading(0, x=50.0), scenario.body))
    back = Own(reading(200, x=52.0), scenario.body, 0)
    decision.record(back)
    assert decision._place == (200, back.x, back.y)


# What speaks for a place ----------------------------------------------------------------------------------------------


def evidence_of(*hits):
    evidence = Evidence(TABLE)
    for k, x, y in hits:
        evidence.add(k, unpack(record(hit=True, x=x, y=y, D=0.05), ARENA))
    return evidence


def test_a_meeting_is_a_hit_after_a_pause():
    evidence = evidence_of((10, 42.0, 3.0), (11, 42.0, 3.0), (14, 42.0, 3.0), (20, 42.0, 3.0), (21, 42.0, 3.0))
    assert evidence.meetings(0, 40.0, 3.0) == 2, "after 10 and 14 a hit came within three seconds"
    assert evidence.meetings(10, 40.0, 3.0) == 1, "since then"
    assert evidence.meetings(20, 40.0, 3.0) == 0


def test_a_meeting_counts_for_a_place_that_explains_it():
    evidence = evidence_of((10, 42.0, 3.0), (20, 42.0, 4.4), (30, 42.0, 3.0))
    assert evidence.meetings(0, 40.0, 3.0) == 2, "the one 1.4 m beside it neither speaks for it nor against it"
    assert evidence.meetings(0, 39.0, 3.0) == 2


def test_a_meeting_far_downwind_does_not_count():
    evidence = evidence_of((10, 42.0, 3.0), (20, 48.0, 3.0), (30, 42.0, 3.0))
    assert evidence.meetings(0, 40.0, 3.0) == 2


@pytest.mark.parametrize("where", [(42.0, 6.0), (36.0, 3.0)], ids=["beside", "upwind"])
def test_a_hit_that_a_source_there_does_not_give_speaks_against_the_place(where):
    evidence = evidence_of((10, 42.0, 3.0), (20, *where), (30, 42.0, 3.0))
    assert evidence.meetings(0, 40.0, 3.0) == 1, "only the one after it"


def test_only_so_many_hits_are_kept():
    evidence = evidence_of(*((10 * k, 42.0, 3.0) for k in range(1000)))
    assert 128 <= evidence.meetings(-1, 40.0, 3.0) <= 256


def test_a_decision_tells_the_meetings_of_which_it_knows():
    scenario = view(algorithm="plume-map", topology="line")
    decision = PlumeMapDecision(scenario)
    for k, ppt in enumerate((0.0, 9000.0, 9000.0, 0.0, 0.0, 0.0, 9000.0, 0.0, 0.0, 0.0)):
        decision.record(Own(reading(20 * k, ppt=ppt), scenario.body))
    assert [decision.meetings(since, (50.0, 0.0)) for since in (0.0, 1.0, 6.0)] == [2, 1, 0]
