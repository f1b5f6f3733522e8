"""The bus in memory behaves as wires do: links are physical, death is seen, bytes change nothing."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.bus import Asked, Delivery, Lost, Seen
from protocol.codec import Codec
from protocol.memory_bus import MemoryBus, MemoryNetwork
from protocol.messages import Ask, Drive, Halt, Reading

LINE = [("robot/0", "robot/1"), ("robot/1", "robot/2")]
NAMES = ("robot/0", "robot/1", "robot/2")


def line(*, wire: bool = False) -> tuple[MemoryNetwork, list[MemoryBus]]:
    network = MemoryNetwork(LINE, token=5, wire=wire)
    buses = [network.join(name) for name in NAMES]
    for bus in buses:
        bus.subscribe("robot/*/drive", Drive)
        heard(bus)
    return network, buses


def heard(bus: MemoryBus) -> list[object]:
    """All events that wait for `bus`."""
    events = []
    while (event := bus.receive(0)) is not None:
        events.append(event)
    return events


@pytest.mark.parametrize("wire", [False, True])
def test_a_message_reaches_the_linked_members_and_nobody_else(wire: bool) -> None:
    _, (a, b, c) = line(wire=wire)
    drive = Drive(0, 1, 0.5, -0.5)
    a.publisher("robot/0/drive", reliable=True)(drive)
    assert heard(b) == [Delivery("robot/0/drive", drive)]
    assert heard(c) == []
    assert heard(a) == []


def test_a_member_sees_those_that_join_and_is_seen() -> None:
    network = MemoryNetwork(LINE)
    a = network.join("robot/0")
    b = network.join("robot/1")
    assert heard(a) == [Seen("robot/1")]
    assert heard(b) == [Seen("robot/0")]
    c = network.join("robot/2")
    assert heard(a) == []
    assert heard(b) == [Seen("robot/2")]
    assert heard(c) == [Seen("robot/1")]


@pytest.mark.parametrize("end", ["kill", "close"])
def test_a_member_that_dies_is_lost_after_what_it_said(end: str) -> None:
    network, (a, b, c) = line()
    say = b.publisher("robot/1/drive", reliable=True)
    say(Drive(1, 1, 0.0, 0.0))
    if end == "kill":
        network.kill("robot/1")
    else:
        b.close()
        b.close()
    say(Drive(1, 2, 0.0, 0.0))
    for other in (a, c):
        assert heard(other) == [Delivery("robot/1/drive", Drive(1, 1, 0.0, 0.0)), Lost("robot/1")]
    assert a.links() == b.links() == c.links() == frozenset()


def test_a_member_that_comes_back_is_another_one() -> None:
    network, (a, old, _) = line()
    say_old = old.publisher("robot/1/drive", reliable=True)
    network.kill("robot/1")
    new = network.join("robot/1")
    heard(a)
    say_old(Drive(1, 1, 0.0, 0.0))
    old.close()
    assert heard(a) == []
    assert a.links() == {"robot/1"}
    new.publisher("robot/1/drive", reliable=True)(Drive(1, 2, 0.0, 0.0))
    assert heard(a) == [Delivery("robot/1/drive", Drive(1, 2, 0.0, 0.0))]


def test_a_message_of_a_kind_that_is_not_said_there_is_refused() -> None:
    _, (a, b, _) = line()
    a.publisher("robot/0/drive", reliable=True)(Halt(1, "no"))
    assert heard(b) == []
    assert (b.counters.received, b.counters.refused) == (0, 1)


@given(st.binary(max_size=60))
def test_foreign_bytes_are_counted_and_dropped(noise: bytes) -> None:
    network, (_, b, _) = line(wire=True)
    network.inject("robot/1", "robot/0/drive", noise)
    network.inject("robot/1", "robot/0/drive", Codec(6).encode(Drive(0, 1, 0.0, 0.0)))
    assert heard(b) == []
    assert b.counters.refused == 2


@given(st.lists(st.tuples(st.integers(0, 2), st.booleans(), st.integers(0, 9)), max_size=30))
def test_bytes_change_nothing(script: list[tuple[int, bool, int]]) -> None:
    """The same story with and without the codec: who hears what in which order, who dies, what is counted."""

    def play(wire: bool) -> list[object]:
        network, buses = line(wire=wire)
        told: list[object] = []
        for i, dies, tick in script:
            if dies and tick == 0:
                network.kill(NAMES[i])
            else:
                kind = Halt(tick, "no") if dies else Drive(i, tick, tick / 7, -0.0)
                buses[i].publisher(f"robot/{i}/drive", reliable=False)(kind)
            told.append([heard(bus) for bus in buses])
        return [*told, *((c.sent, c.received, c.dropped, c.refused) for c in (bus.counters for bus in buses))]

    assert play(wire=False) == play(wire=True)


def test_a_subscription_made_later_counts_from_then_on() -> None:
    _, (a, b, _) = line()
    say = a.publisher("robot/0/reading", reliable=True)
    reading = Reading(0, 1, 0.0, *[0.0] * 8)
    say(reading)
    assert not a.matched("robot/0/reading", ["robot/1"])
    b.subscribe("robot/0/reading", Reading)
    assert a.matched("robot/0/reading", ["robot/1"])
    assert not a.matched("robot/0/reading", ["robot/2"])
    say(reading)
    assert heard(b) == [Delivery("robot/0/reading", reading)]


def test_a_query_reaches_the_linked_servers_and_the_asker_gets_no_answer_in_the_same_thread() -> None:
    _, (a, b, c) = line()
    b.serve("robot/*/join", Ask)
    c.serve("robot/*/join", Ask)
    assert a.ask("robot/0/join", Ask(0), timeout=1.0) is None
    (asked,) = heard(b)
    assert isinstance(asked, Asked)
    assert (asked.key, asked.message) == ("robot/0/join", Ask(0))
    asked.answer(Ask(1))
    assert heard(c) == []
    assert a.ask("scenario", Ask(0), timeout=1.0) is None
    assert heard(b) == []


def test_a_network_of_messages_takes_no_bytes() -> None:
    network, _ = line()
    with pytest.raises(ValueError, match="wire=True"):
        network.inject("robot/1", "robot/0/drive", b"bytes")
