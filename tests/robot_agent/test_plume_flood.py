"""plume-map: events reach everybody, whatever the graph, loss and outages."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from judging_helpers import reading, view
from plume_helpers import record

from robot_agent.decision.plume_map import PlumeMapDecision
from robot_agent.hand import Own
from robot_agent.plume.events import SIZE
from robot_agent.plume.flood import Flood

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
