"""The swarm declares the source: one robot by hand, then groups of them on graphs that lose, break and change."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.messages import Shared
from protocol.randomness import rng_for
from protocol.scenario import robot_view
from protocol.scenario.load import load_scenario
from robot_agent.declaration import UNSURE, Declaration

TICK = 0.05
EACH_SECOND = 20  # ticks
HERE = (10.2, 0.1)
P = load_scenario(None).declaration
PERIOD = round(P.period / TICK)


def group(n: int, **values: object) -> list[Declaration]:
    chosen = {"robots": n, "topology": "all" if n > 1 else "line", "declaration.stop": "declared", **values}
    scenario = load_scenario(None, overrides=[(path, value, "test") for path, value in chosen.items()])
    return [Declaration(robot_view(scenario, i)) for i in range(n)]


def said(robot: int = 0, votes: tuple = (), declared: tuple | None = None) -> Shared:
    return Shared(robot, 0, *[0.0] * 11, 0, 0, *[0.0] * 4, votes=votes, declared=declared)


def tell(who: Declaration, robot: int, tick: int) -> Shared:
    return said(robot, who.votes(tick, tick * TICK), who.made)


def vote(robot: int, t: float, place: tuple[float, float] = HERE, radius: float = 0.1) -> Shared:
    return said(robot, ((robot, t, *place, radius),))


def judged(who: Declaration, seconds: Iterable[int], place=HERE, radius: float | None = 0.1) -> None:
    for t in seconds:
        who.judge(float(t), place, radius)


class Exchange:
    """A group whose members exchange every tick over edges (listener, speaker) that may change and lose."""

    def __init__(self, n: int, edges, loss: float = 0.0, **values: object) -> None:
        self.members = dict(enumerate(group(n, **values)))
        self.edges = edges if callable(edges) else lambda tick: edges
        self.loss = loss
        self.tick = 0
        self.place = dict.fromkeys(range(n), HERE)
        self.radius: dict[int, float | None] = dict.fromkeys(range(n), 0.1)

    def run(self, seconds: float) -> Exchange:
        for _ in range(round(seconds / TICK)):
            t = self.tick * TICK
            told = {i: tell(who, i, self.tick) for i, who in self.members.items()}
            for i, who in self.members.items():
                who.hear(t, [told[j] for a, j in self.edges(self.tick) if a == i and j in told and self._arrives(i, j)])
                if self.tick % EACH_SECOND == 0:
                    who.judge(t, self.place[i], self.radius[i])
            self.tick += 1
        return self

    def _arrives(self, i: int, j: int) -> bool:
        return rng_for(1, "link", i, j, self.tick).uniform() >= self.loss

    @property
    def made(self) -> set:
        return {who.made for who in self.members.values()}


def line(n: int) -> list[tuple[int, int]]:
    return [(i, j) for i in range(n) for j in (i - 1, i + 1) if 0 <= j < n]


def test_a_lone_robot_declares_when_it_has_been_sure_long_enough_and_not_before() -> None:
    (who,) = group(1)
    judged(who, range(3, 3 + int(P.hold)))
    assert who.made is None
    judged(who, [3 + int(P.hold)])
    assert who.made == (3.0 + P.hold, 0, *HERE)


def test_doubt_in_between_begins_the_waiting_again() -> None:
    for radius in (P.radius * 1.01, None):
        (who,) = group(1)
        judged(who, range(4))
        judged(who, [4], radius=radius)
        judged(who, range(5, 5 + int(P.hold)))
        assert who.made is None
        judged(who, [5 + int(P.hold)])
        assert who.made is not None


def test_an_estimate_that_wanders_is_not_declared() -> None:
    (who,) = group(1)
    for t in range(60):
        who.judge(float(t), (10.0 + 0.2 * t, 0.0), 0.1)
    assert who.made is None


def test_a_place_is_not_declared_before_the_odour_was_met_again_there() -> None:
    (who,) = group(1)
    for t in range(60):
        who.judge(float(t), HERE, 0.1, meetings=lambda since, place: P.meetings - 1)
    assert who.made is None
    who.judge(60.0, HERE, 0.1, meetings=lambda since, place: P.meetings)
    assert who.made == (60.0, 0, *HERE)


@pytest.mark.parametrize(
    ("place", "radius"),
    [((HERE[0] + P.tolerance + 0.01, HERE[1]), 0.1), (HERE, P.radius + 0.01), (HERE, UNSURE)],
    ids=["elsewhere", "wide", "unsure"],
)
def test_one_robot_that_does_not_agree_keeps_all_from_declaring(place: tuple[float, float], radius: float) -> None:
    who = group(3)[0]
    for t in range(30):
        who.hear(float(t), [vote(1, float(t)), vote(2, float(t), place, radius)])
        judged(who, [t])
    assert who.made is None
    who.hear(30.0, [vote(2, 30.0)])
    judged(who, [30])
    assert who.made == (30.0, 0, *HERE)


def test_a_robot_that_is_heard_of_no_more_is_not_asked() -> None:
    who = group(2)[0]
    who.hear(0.0, [vote(1, 0.0, radius=UNSURE)])
    judged(who, range(int(P.window) + 1))
    assert who.made is None
    judged(who, [int(P.window) + 1])
    assert who.made is not None


def test_a_late_vote_does_not_bring_a_dead_robot_back_and_never_replaces_a_newer_one() -> None:
    who = group(2)[0]
    who.hear(0.0, [vote(1, 5.0)])
    who.hear(1.0, [vote(1, 4.0, radius=UNSURE)])
    judged(who, range(2 + int(P.window)))
    assert who.made[0] == P.hold
    who.hear(50.0, [vote(1, 5.0)])
    assert [record[0] for record in who.votes(0, 50.0)] == []


def test_votes_of_the_dead_do_not_go_round_a_ring_for_ever() -> None:
    n = 4
    ring = Exchange(n, [(i, j % n) for i in range(n) for j in (i - 1, i + 1)])
    ring.radius = dict.fromkeys(range(n), None)
    ring.run(3.0)
    del ring.members[2]
    ring.run(P.window + 2.0)
    tick = -(-ring.tick // PERIOD) * PERIOD
    assert [[record[0] for record in who.votes(tick, ring.tick * TICK)] for who in ring.members.values()] == [[0, 1, 3]] * 3


RECORD = st.tuples(
    st.integers(0, 3).map(float), st.integers(0, 2), st.integers(0, 50).map(float), st.integers(-50, 50).map(float)
)


@given(st.lists(RECORD, min_size=1, max_size=6), st.randoms(use_true_random=False))
def test_the_earliest_declaration_wins_in_whatever_order_and_however_often_they_come(records: list, order) -> None:
    one, two = group(3)[:2]
    one.hear(0.0, [said(declared=record) for record in records])
    again = records * 2
    order.shuffle(again)
    for record in again:
        two.hear(9.0, [said(declared=record)])
    assert one.made == two.made == min(records)


@pytest.mark.parametrize("record", [(5.0, 7, *HERE), (5.0, -1, *HERE), (-1.0, 0, *HERE), (5.0, 0, 500.0, 0.0)])
def test_a_declaration_that_cannot_be_is_not_adopted(record: tuple) -> None:
    who = group(2)[0]
    who.hear(6.0, [said(1, declared=record)])
    assert who.made is None


GRAPHS = {
    "line": line(6),
    "directed ring": [(i, (i - 1) % 6) for i in range(6)],
    "switching line": lambda tick: [edge for edge in line(6) if (min(edge) + tick // 10) % 2],
    "star": [(i, j) for i in range(6) for j in range(6) if 0 in (i, j) and i != j],
}


@pytest.mark.parametrize("edges", GRAPHS.values(), ids=list(GRAPHS))
@pytest.mark.parametrize("loss", [0.0, 0.5])
def test_on_any_graph_that_is_connected_over_time_all_tell_the_same_place(edges, loss: float) -> None:
    swarm = Exchange(6, edges, loss)
    swarm.place = {i: (10.0 + 0.05 * i, 0.0) for i in range(6)}
    swarm.run(P.hold + 10.0)
    (made,) = swarm.made
    assert made is not None
    assert made[2:] == swarm.place[made[1]]


@pytest.mark.parametrize("edges", GRAPHS.values(), ids=list(GRAPHS))
def test_doubt_of_one_robot_far_away_reaches_all_through_loss(edges) -> None:
    swarm = Exchange(6, edges, 0.5)
    swarm.radius[5] = None
    assert swarm.run(60.0).made == {None}


def test_two_parts_that_declared_apart_tell_the_earlier_place_once_they_meet() -> None:
    apart = [edge for edge in line(4) if edge not in ((1, 2), (2, 1))]
    swarm = Exchange(4, lambda tick: apart if tick * TICK < 40.0 else line(4))
    swarm.place |= {2: (12.0, 0.0), 3: (12.0, 0.0)}
    swarm.radius |= {2: None, 3: None}
    swarm.run(15.0)
    swarm.radius |= {2: 0.1, 3: 0.1}
    swarm.run(24.0)
    assert {made[2] for made in swarm.made} == {HERE[0], 12.0}
    swarm.run(2.0)
    assert {made[2:] for made in swarm.made} == {HERE}


def test_a_robot_that_joins_late_adopts_what_was_declared() -> None:
    swarm = Exchange(3, line(3))
    newcomer = swarm.members.pop(2)
    swarm.run(P.hold + 3.0)
    swarm.members[2] = newcomer
    swarm.run(0.5)
    (made,) = swarm.made
    assert made is not None


def test_a_robot_that_joined_late_holds_nobody_up_until_it_is_sure_itself() -> None:
    late, old = group(2)
    late.judge(0.0, (90.0, 0.0), 5.0, late=True)
    assert late.votes(0, 0.0) == ()
    for t in range(1, 9):
        late.judge(float(t), (90.0, 0.0), 0.1, late=True)
    assert [v[0] for v in late.votes(10 * PERIOD, 8.0)] == [0]
    old.hear(8.0, [vote(0, 8.0, (90.0, 0.0))])
    judged(old, range(8, 16))
    assert old.made is None  # it is sure of another place now, and that counts


def test_clocks_that_differ_do_no_harm() -> None:
    who = group(2)[0]
    for t in range(60):
        who.hear(float(t), [vote(1, t - 1000.0 + t, radius=UNSURE)])
        judged(who, [t])
    assert who.made is None


def test_in_a_run_that_ends_at_the_source_nobody_votes() -> None:
    who = group(2, **{"declaration.stop": "reached"})[0]
    who.hear(0.0, [said(1, declared=(0.0, 1, *HERE))])
    judged(who, range(30))
    assert (who.made, who.votes(0, 30.0)) == (None, ())


def test_a_robot_that_stood_still_must_be_sure_anew_for_nobody_has_told_it_his_vote_lately() -> None:
    who = group(2)[0]
    who.hear(0.0, [vote(1, 0.0, radius=UNSURE)])
    judged(who, range(int(P.hold) + 2))
    back = 2 * (P.hold + P.window)
    judged(who, [back])
    assert who.made is None
    judged(who, [back + second for second in range(1, int(P.hold) + 1)])
    assert who.made[0] == back + P.hold


def test_votes_that_were_due_at_a_tick_that_was_missed_are_told_at_the_next() -> None:
    who = group(2)[0]
    judged(who, [0])
    told = [bool(who.votes(tick, tick * TICK)) for tick in (0, 1, PERIOD + 2, PERIOD + 3, 2 * PERIOD)]
    assert told == [True, False, True, False, True]
