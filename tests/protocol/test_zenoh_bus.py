"""Messages over Zenoh: links are physical, rubbish is refused, nobody hears what is not for it.

Every wait is for a condition with a deadline. These stories need no processes: a member is an object with a session.
"""

import logging
import threading

import pytest
from zenoh_wires import DEADLINE, RUN, TOKEN, Wires, await_event, drive, drives, line, link_up, until

from protocol import inbox
from protocol.bus import Asked, Delivery, Lost, Seen
from protocol.codec import Codec
from protocol.messages import Ask, Drive, Field, Halt


@pytest.mark.parametrize("lockstep", [False, True])
def test_a_message_reaches_linked_members_and_nobody_else(wires: Wires, lockstep: bool) -> None:
    a, b, c = line(wires, lockstep=lockstep)
    say_a = a.publisher("robot/1/drive", reliable=True)
    say_b = b.publisher("robot/2/drive", reliable=True)
    until(lambda: a.matched("robot/1/drive", ["robot/2"]), "b hears a")
    until(lambda: b.matched("robot/2/drive", ["robot/1", "robot/3"]), "a and c hear b")
    for tick in range(20):
        say_a(drive(tick))
    heard = await_event(b, lambda e: isinstance(e, Delivery) and e.message.tick == 19)
    assert drives(heard) == [("robot/1/drive", tick) for tick in range(20)]
    # What b says comes over the same link that would have relayed a's words, and after them.
    say_b(drive(100))
    for bus in (a, c):
        heard = await_event(bus, lambda e: isinstance(e, Delivery))
        assert drives(heard) == [("robot/2/drive", 100)]
    assert [bus.counters.received for bus in (a, b, c)] == [1, 20, 1]
    assert [bus.counters.refused for bus in (a, b, c)] == [0, 0, 0]


@pytest.mark.parametrize("lockstep", [False, True])
def test_liveliness_and_links_reach_direct_neighbours_only(wires: Wires, lockstep: bool) -> None:
    a, b, c = line(wires, lockstep=lockstep)
    assert (a.links(), b.links(), c.links()) == ({"robot/2"}, {"robot/1", "robot/3"}, {"robot/2"})
    c.close()
    assert Seen("robot/1") in await_event(b, Lost("robot/3"))
    b.close()
    assert await_event(a, Lost("robot/2")) == [Seen("robot/2"), Lost("robot/2")]
    until(lambda: not (a.links() or b.links() or c.links()), "nobody is linked")


def test_whoever_is_matched_hears_the_first_message(wires: Wires) -> None:
    """Also with several listeners, of whom Zenoh tells only that there is one."""
    listeners = [f"robot/{i}" for i in range(1, 5)]
    centre = wires.member("robot/0")
    say = centre.publisher("robot/0/drive", reliable=True)
    others = [wires.member(name, "robot/0") for name in listeners]
    for other in others:
        assert not centre.matched("robot/0/drive", listeners)
        other.subscribe("robot/0/drive", Drive)
        other.links()
    until(lambda: centre.matched("robot/0/drive", listeners), "all listen")
    say(drive(1))
    for other in others:
        assert drives(await_event(other, lambda e: isinstance(e, Delivery))) == [("robot/0/drive", 1)]


def test_a_stranger_is_seen_as_a_link_and_its_frames_are_refused(
    wires: Wires, caplog: pytest.LogCaptureFixture
) -> None:
    """A process of another run under the same run name: other token, same keys."""
    a = wires.member("robot/1")
    stranger = wires.member("robot/2", "robot/1", token=TOKEN + 1)
    friend = wires.member("robot/3", "robot/1")
    a.subscribe("robot/*/drive", Drive)
    link_up(a, friend, stranger)
    until(lambda: len(a.links()) == 2, "both are linked")
    assert "robot/3" in a.links()
    assert any(name.startswith("stranger/") for name in a.links())
    lie = stranger.publisher("robot/2/drive", reliable=True)
    say = friend.publisher("robot/3/drive", reliable=True)
    until(lambda: stranger.matched("robot/2/drive", []) and friend.matched("robot/3/drive", []), "a hears both")
    with caplog.at_level(logging.WARNING, logger="protocol.zenoh_bus"):
        for tick in range(5):
            lie(drive(tick))
        # Counted where they are opened: the queue also holds who has come and gone.
        until(lambda: a.receive(0) is None and a.counters.refused == 5, "the lies are refused")
        say(drive(7))
        assert drives(await_event(a, lambda e: isinstance(e, Delivery))) == [("robot/3/drive", 7)]
    assert a.counters.refused == 5
    assert [r.levelname for r in caplog.records] == ["WARNING"]
    assert "robot/2/drive" in caplog.text


@pytest.mark.parametrize("lockstep", [False, True])
def test_malformed_frames_are_counted_and_hurt_nobody(
    wires: Wires, caplog: pytest.LogCaptureFixture, lockstep: bool
) -> None:
    a = wires.member("robot/1", lockstep=lockstep)
    b = wires.member("robot/2", "robot/1", lockstep=lockstep)
    a.subscribe("robot/*/drive", Drive)
    a.subscribe("robot/2/report", Drive)
    link_up(a, b)
    say = b.publisher("robot/2/drive", reliable=True)
    until(lambda: b.matched("robot/2/drive", ["robot/1"]), "a hears b")
    good = Codec(TOKEN).encode(drive(1))
    rubbish = [
        b"",
        b"secret",
        good[:-1],
        good + b"\0",
        bytes([good[0] ^ 1]) + good[1:],
        Codec(TOKEN).encode(Halt(1, "secret")),
        bytes(60_000),
    ]
    raw = b._session.declare_publisher(f"odour/{RUN}/robot/2/drive")
    with caplog.at_level(logging.WARNING, logger="protocol.zenoh_bus"):
        for frame in rubbish:
            raw.put(frame)
        raw.delete()
        b._session.put(f"odour/{RUN}/robot/2/report", b"secret")
        until(lambda: a.receive(0) is None and a.counters.refused == len(rubbish) + 2, "the rubbish is refused")
        say(drive(5))
        heard = await_event(a, lambda e: isinstance(e, Delivery))
    assert drives(heard) == [("robot/2/drive", 5)]
    assert (a.counters.received, a.counters.refused) == (1, len(rubbish) + 2)
    assert len(caplog.records) == 2  # once per key
    assert "secret" not in caplog.text


def test_a_refused_frame_does_not_end_a_wait_early(wires: Wires) -> None:
    a, b = wires.member("robot/1"), wires.member("robot/2", "robot/1")
    a.subscribe("robot/2/drive", Drive)
    link_up(a, b)
    await_event(a, Seen("robot/2"))
    lie = b.publisher("robot/2/drive", reliable=True)
    until(lambda: b.matched("robot/2/drive", ["robot/1"]), "a hears b")
    lie(Halt(1, "not here"))
    until(lambda: a._inbox._size() == 1, "the frame is there")

    def speak_when_it_is_taken_out() -> None:
        until(lambda: a.counters.refused == 1, "the frame is refused")
        lie(drive(1))

    threading.Thread(target=speak_when_it_is_taken_out, daemon=True).start()
    assert a.receive(DEADLINE) == Delivery("robot/2/drive", drive(1))
    assert a.receive(0.01) is None


def test_a_frame_that_is_too_large_never_arrives_and_the_link_lives_on(wires: Wires) -> None:
    a, b = wires.member("robot/1"), wires.member("robot/2", "robot/1")
    a.subscribe("field", Field)
    link_up(a, b)
    say = b.publisher("field", reliable=True)
    until(lambda: b.matched("field", ["robot/1"]), "a hears b")
    say(Field(1, 0.0, bytes(3_000_000), b""))
    say(Field(2, 0.0, bytes(500_000), b""))
    (*_, event) = await_event(a, lambda e: isinstance(e, Delivery))
    assert event.message.tick == 2
    assert "robot/2" in a.links()


def test_a_flood_is_bounded_and_hides_no_loss(wires: Wires, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inbox, "MAX_ENTRIES", 50)
    a, b = wires.member("robot/1"), wires.member("robot/2", "robot/1")
    a.subscribe("robot/2/drive", Drive)
    link_up(a, b)
    await_event(a, Seen("robot/2"))
    say = b.publisher("robot/2/drive", reliable=True)
    until(lambda: b.matched("robot/2/drive", ["robot/1"]), "a hears b")
    for tick in range(400):
        say(drive(tick))
    until(lambda: a.counters.dropped == 350, "the flood is over")
    b.close()
    heard = await_event(a, Lost("robot/2"))
    assert drives(heard) == [("robot/2/drive", tick) for tick in range(50)]


def test_nobody_hears_itself(wires: Wires) -> None:
    a, b = wires.member("robot/1"), wires.member("robot/2", "robot/1")
    for bus in (a, b):
        bus.subscribe("robot/*/drive", Drive)
        bus.serve("scenario", Ask)
    link_up(a, b)
    say = a.publisher("robot/1/drive", reliable=True)
    until(lambda: a.matched("robot/1/drive", ["robot/2"]), "b hears a")
    say(drive(1))
    await_event(b, lambda e: isinstance(e, Delivery))
    b.publisher("robot/2/drive", reliable=True)(drive(2))
    assert drives(await_event(a, lambda e: isinstance(e, Delivery))) == [("robot/2/drive", 2)]
    assert a.ask("scenario", Ask(1), timeout=0.1) is None  # b is asked and does not answer
    assert not any(isinstance(a.receive(0), Asked) for _ in range(5))
