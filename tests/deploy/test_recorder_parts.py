"""The recorder's numbers before Rerun dresses them: decisions, links, gaps, colours, scales."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from recorder_helpers import RING, N, belief, pose, truth

from deploy.recorder import palette
from deploy.recorder.decisions import PATIENCE, VALID, Board
from deploy.recorder.links import BROKEN, CLOSED, HEARD, SILENT, LinkWatch
from deploy.recorder.track import Gaps, track_of
from protocol.scenario import Stage

EVERYBODY = range(N)


def ticks(rows):
    return [row.tick for row in rows]


def test_a_decision_waits_for_the_robots_that_live():
    board = Board(N, 1.0)
    board.add(belief(i, 0) for i in (0, 1, 3))
    assert board.rows(EVERYBODY) == []
    board.add([belief(2, 0)])
    (row,) = board.rows(EVERYBODY)
    assert list(row.beliefs) == [0, 1, 2, 3]


def test_a_decision_does_not_wait_for_the_dead():
    board = Board(N, 1.0)
    board.add(belief(i, 0) for i in (0, 1, 3))
    assert ticks(board.rows({0, 1, 3})) == [0]


def test_a_decision_waits_no_longer_than_its_patience_for_the_silent():
    board = Board(N, 1.0)
    for k in range(PATIENCE + 2):
        board.add(belief(i, 20 * k) for i in (0, 1, 3))
        gone = board.rows(EVERYBODY)
        assert bool(gone) == (k > PATIENCE)
    assert ticks(gone) == [20 * k for k in range(PATIENCE + 2)]


def test_a_robot_whose_message_was_lost_is_not_waited_for_when_it_spoke_later():
    board = Board(N, 1.0)
    board.add(belief(i, 0) for i in EVERYBODY)
    board.add(belief(i, 20) for i in (0, 1, 3))
    board.add([belief(2, 40)])
    assert ticks(board.rows(EVERYBODY)) == [0, 20]


def test_what_was_said_stays_valid_for_a_while_and_not_longer():
    board = Board(2, 1.0)
    board.add([belief(1, 0)])
    board.add(belief(0, 20 * k) for k in range(VALID + 2))
    heard = [1 in row.beliefs for row in board.rows({0})]
    assert heard == [True] * (VALID + 1) + [False]


def test_a_belief_that_comes_after_its_row_is_counted_and_changes_nothing():
    board = Board(2, 1.0)
    board.add([belief(0, 0), belief(0, 20)])
    assert ticks(board.rows({0})) == [0, 20]
    board.add([belief(1, 0)])
    assert board.late == 1
    assert board.rows({0, 1}, all_of_them=True) == []


@given(st.lists(st.tuples(st.integers(0, N - 1), st.integers(0, 8)), unique=True), st.randoms(use_true_random=False))
def test_rows_come_in_order_and_hold_every_belief_once_whatever_the_order_of_arrival(said, shuffle):
    arrived = list(said)
    shuffle.shuffle(arrived)
    board, rows = Board(N, 1.0), []
    for i, k in arrived:
        board.add([belief(i, 20 * k)])
        rows += board.rows(EVERYBODY)
    rows += board.rows(EVERYBODY, all_of_them=True)
    assert ticks(rows) == sorted(set(ticks(rows)))
    new = [(b.robot, b.tick) for row in rows for b in row.beliefs.values() if b.tick == row.tick]
    assert len(new) == len(set(new)) == len(said) - board.late


def kinds_by_hand(alive, links, heard):
    """The rule, robot by robot, for the pairs of the ring in the order of their numbers."""
    kinds = []
    for a, b in sorted({tuple(sorted((i, j))) for i, j, _ in RING}):
        up = a in alive and b in alive and b in links[a] and a in links[b]
        used = b in heard[a] and a in heard[b]
        kinds.append(BROKEN if not up else HEARD if used else SILENT)
    return kinds


SOME = st.frozensets(st.integers(0, N - 1))


@given(SOME, st.tuples(*[SOME] * N), st.tuples(*[SOME] * N))
def test_links_are_judged_as_the_rule_says(alive, links, heard):
    watch = LinkWatch(RING, N, 1.0)
    watch.hear([belief(i, 0, links=tuple(links[i]), heard=tuple(heard[i])) for i in EVERYBODY])
    kinds = watch.at(0.0, np.array([i in alive for i in EVERYBODY]))
    assert kinds.tolist() == kinds_by_hand(alive, links, heard)


def test_a_belief_counts_from_its_own_time_on_and_goes_stale():
    everybody = np.ones(N, dtype=bool)
    watch = LinkWatch(RING, N, 1.0)
    watch.hear([belief(i, 20) for i in EVERYBODY])
    assert set(watch.at(0.5, everybody).tolist()) == {SILENT}
    assert set(watch.at(1.0, everybody).tolist()) == {HEARD}
    assert set(watch.at(1.0 + VALID + 0.1, everybody).tolist()) == {SILENT}


def test_a_link_is_closed_while_the_schedule_or_the_range_says_so():
    line = tuple(edge for edge in RING if abs(edge[0] - edge[1]) == 1)
    watch = LinkWatch(RING, N, 1.0, (Stage(0.0, "ring", 0.0, RING), Stage(2.0, "line", 5.0, line)), 4.0)
    everybody, near = np.ones(N, dtype=bool), np.array([(4.0 * i, 0.0) for i in EVERYBODY])
    pairs = [tuple(pair) for pair in watch.pairs.tolist()]

    def closed(t, points):
        return {pair for pair, kind in zip(pairs, watch.at(t, everybody, points), strict=True) if kind == CLOSED}

    assert closed(1.0, near) == set()
    assert closed(2.0, near) == {(0, N - 1)}
    assert closed(3.0, 2 * near) == set(pairs)
    assert closed(4.0, 2 * near) == set()


@given(st.sets(st.integers(0, 30)), st.randoms(use_true_random=False))
def test_gaps_are_told_by_the_running_numbers_in_any_order(numbers, shuffle):
    arrived = [truth(2 * k, k) for k in numbers]
    shuffle.shuffle(arrived)
    gaps = Gaps()
    for k in range(0, len(arrived), 3):
        gaps.take(arrived[k : k + 3])
    assert gaps.sent == max(numbers, default=-1) + 1
    assert gaps.lost == gaps.sent - len(numbers)


def test_truth_becomes_arrays_in_the_order_of_time():
    track, misfits = track_of([truth(40, 20), truth(0, 0, frozenset({1}))], N)
    assert misfits == 0
    assert track.ticks.tolist() == [0, 40]
    assert track.points[1, 3] == pytest.approx(pose(3, 2.0)[:2])
    assert track.alive.tolist() == [[True, False, True, True], [True] * N]


def test_robots_have_different_colours_that_stand_out_from_the_background():
    def luminance(colour):
        channels = [((colour >> shift) & 255) / 255 for shift in (24, 16, 8)]
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    colours = [palette.robot_colour(i) for i in range(50)]
    assert len(set(colours)) == 50
    dark = luminance(palette.BACKGROUND)
    contrast = [(luminance(c) + 0.05) / (dark + 0.05) for c in colours]
    assert min(contrast) >= 3.0  # what WCAG 2 asks of graphics


@pytest.mark.parametrize(
    ("low", "high", "values"),
    [(0.0, 100.0, [0, 20, 40, 60, 80, 100]), (-50.0, 50.0, [-40, -20, 0, 20, 40]), (0.3, 2.2, [0.5, 1.0, 1.5, 2.0])],
)
def test_the_scale_stands_at_round_numbers(low, high, values):
    from deploy.recorder.layers.scenery import round_step
    from deploy.recorder.layers.scenery import ticks as scale

    assert scale(low, high, round_step(high - low)) == pytest.approx(values)
