"""plume-map's messages: what they say, how long they are, and bytes that are none."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.plume.events import SIZE
from robot_agent.plume.flood import Flood
from robot_agent.plume.wire import Wire

WINDOW = 12


def record(robot, k=0):
    return robot.to_bytes(2, "little") + bytes((k % 256,)) * (SIZE - 2)


def bits_of(keys, upto, robots):
    return sum(1 << (k - upto + WINDOW - 1) * robots + robot for k, robot in keys)


@given(st.data(), st.integers(1, 20), st.integers(0, 200_000), st.integers(0, 2))
def test_what_was_written_is_read(data, robots, newest, before):
    """A clock that differs by hours does no harm to the number of the decision."""
    wire, upto = Wire(robots, WINDOW), newest - before
    places = st.tuples(st.integers(max(0, upto - WINDOW + 1), max(0, upto)), st.integers(0, robots - 1))
    has = data.draw(st.sets(places if upto >= 0 else st.nothing()))
    ages = st.tuples(st.integers(0, min(newest, WINDOW - 1)), st.integers(0, robots - 1))
    events = [((newest - age, i), record(i, age)) for age, i in sorted(data.draw(st.sets(ages, max_size=30)))]
    message = wire.write(newest, upto, 0, bits_of(has, upto, robots), events)
    told = wire.read(message, newest + data.draw(st.integers(-20_000, 20_000)))
    assert told.upto == upto
    assert told.events == events
    there = bits_of([(k, i) for k in range(max(0, upto - WINDOW + 1), upto + 1) for i in range(robots)], upto, robots)
    assert told.has & there == bits_of(has, upto, robots)


def test_to_have_everything_is_said_in_no_bit_and_a_silent_robot_costs_one_byte():
    wire = Wire(5, WINDOW)
    full = [(k, i) for k in range(39, 51) for i in range(5)]
    assert len(wire.write(50, 50, 39, bits_of(full, 50, 5), [])) == 3
    assert len(wire.write(50, 50, 39, bits_of([key for key in full if key[1] != 2], 50, 5), [])) == 4


def test_an_event_of_five_robots_takes_thirteen_bytes():
    wire = Wire(5, WINDOW)
    assert len(wire.write(50, None, 39, 0, [((50, 2), record(2)), ((39, 4), record(4))])) == 3 + 2 * 13


@given(st.binary(max_size=300), st.integers(1, 20), st.integers(0, 100_000))
def test_any_bytes_are_read_or_left(message, robots, now):
    told = Wire(robots, WINDOW).read(message, now)
    if told is not None:
        assert 0 <= told.has < 1 << robots * WINDOW
        assert all(k >= 0 and 0 <= robot < robots and len(bits) == SIZE for (k, robot), bits in told.events)


def floods(edges, robots):
    return [
        Flood(robots, WINDOW, [j for i, j in edges if i == me], [i for i, j in edges if j == me]) for me in range(robots)
    ]


def sent(edges, robots, seconds=40):
    """Bytes a second of every robot once the window is full; everybody knows all."""
    swarm, total = floods(edges, robots), [0] * robots
    for k in range(seconds):
        for i, robot in enumerate(swarm):
            robot.clock(k)
            robot.add((k, i), record(i, k))
        for tick in range(20):
            told = [robot.tell(tick == 0) for robot in swarm]
            for i, j in edges:
                swarm[i].hear(j, told[j])
            if k >= 20:
                total = [each + len(message) for each, message in zip(total, told, strict=True)]
    assert all(robot._known == swarm[0]._known and len(robot._known) == WINDOW * robots for robot in swarm)
    return [each / (seconds - 20) for each in total]


NEXT = [(i, (i + 1) % 5) for i in range(5)]


@pytest.mark.parametrize(
    ("edges", "mean", "most"),
    [
        ([(i, j) for i in range(5) for j in range(5) if i != j], 19.0, 19.0),
        (NEXT + [(j, i) for i, j in NEXT], 53.0, 53.0),
        (NEXT[:4] + [(j, i) for i, j in NEXT[:4]], 66.0, 90.0),
        (NEXT, 272.0, 272.0),
    ],
    ids=["all", "ring", "line", "directed ring"],
)
def test_five_robots_send_so_many_bytes_a_second_and_no_more(edges, mean, most):
    """On a ring three events a second leave every robot, 39 bytes of the 53; no flood can do with fewer."""
    rates = sent(edges, 5)
    assert sum(rates) / 5 <= mean
    assert max(rates) <= most


def test_a_clock_that_is_set_back_or_far_ahead_leaves_nothing_behind():
    a, b = floods([(0, 1), (1, 0)], 2)
    for k in (100, 101, 5_000_000, 7, 8):
        for i, robot in enumerate((a, b)):
            robot.clock(k)
            robot.add((k, i), record(i, k))
        for _ in range(3):
            for one, other, name in ((a, b, 0), (b, a, 1)):
                other.hear(name, one.tell(True))
        assert all(abs(key[0] - k) < WINDOW for key in a._known)
        assert {(k, 0), (k, 1)} <= set(a._known) == set(b._known)
        assert a._mine.bit_length() <= 2 * WINDOW * 2


def test_one_robot_whose_clock_is_hours_off_is_neither_believed_nor_answered():
    a, b = floods([(0, 1), (1, 0)], 2)
    a.clock(20)
    b.clock(20_000)
    a.add((20, 0), record(0))
    b.add((20_000, 1), record(1))
    assert b.hear(0, a.tell(True)) == []
    assert a.hear(1, b.tell(True)) == []
    assert a.tell(False) == b""
