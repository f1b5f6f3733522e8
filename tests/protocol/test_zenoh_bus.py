"""The bus over Zenoh: links are physical, rubbish is refused, nobody hangs with a peer that hangs.

Every wait is for a condition with a deadline. Most stories need no processes: a member is an object with a session.
"""

import logging
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from pathlib import Path

import pytest

from protocol import inbox
from protocol.bus import Asked, BusEvent, Delivery, Lost, Seen
from protocol.codec import Codec
from protocol.endpoints import default_transport, free_tcp_endpoints, unix_endpoint
from protocol.errors import ScenarioError, SwarmFailure
from protocol.messages import Answer, Ask, Drive, Field, Halt, Message
from protocol.zenoh_bus import ZenohBus, token_of

RUN = "test"
TOKEN = token_of(RUN)
DEADLINE = 20.0  # s
ROOT = Path(__file__).parents[2]
unix_only = pytest.mark.skipif(default_transport() != "unix", reason="needs unix sockets and signals")


class Wires:
    """Members of one run and where they listen."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self.folder, self.stack = folder, stack
        self.endpoints: dict[str, str] = {}

    def at(self, name: str) -> str:
        if name not in self.endpoints:
            unix = default_transport() == "unix"
            self.endpoints[name] = unix_endpoint(self.folder, name) if unix else free_tcp_endpoints(1)[0]
        return self.endpoints[name]

    def member(self, name: str, *linked: str, token: int = TOKEN, **options) -> ZenohBus:
        connect = [self.at(other) for other in linked]
        bus = ZenohBus(RUN, name, token, listen=[self.at(name)], connect=connect, **options)
        self.stack.callback(bus.close)
        return bus

    def process(self, name: str, *linked: str) -> subprocess.Popen:
        ends = [self.at(name), *(self.at(other) for other in linked)]
        child = subprocess.Popen(
            [sys.executable, str(Path(__file__).with_name("zenoh_member.py")), RUN, name, *ends],
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        self.stack.callback(end, child)
        return child


def end(child: subprocess.Popen) -> None:
    child.kill()
    child.wait(DEADLINE)
    child.stdout.close()


@pytest.fixture
def wires() -> Iterator[Wires]:
    # Not tmp_path: a unix socket's path has room for about 100 bytes.
    with tempfile.TemporaryDirectory(prefix="odour-") as folder, ExitStack() as stack:
        yield Wires(Path(folder), stack)


def until(condition: Callable[[], bool], what: str) -> None:
    """Wait for something that is no event."""
    limit = time.monotonic() + DEADLINE
    pause = threading.Event()
    while not condition():
        assert time.monotonic() < limit, f"not within {DEADLINE:g} s: {what}"
        pause.wait(0.005)


def await_event(bus: ZenohBus, wanted: Callable[[BusEvent], bool] | BusEvent) -> list[BusEvent]:
    """Events of `bus` up to the wanted one."""
    limit = time.monotonic() + DEADLINE
    events: list[BusEvent] = []
    while True:
        event = bus.receive(max(0.0, limit - time.monotonic()))
        assert event is not None, f"not within {DEADLINE:g} s: {wanted}; but {events}"
        events.append(event)
        if wanted(event) if callable(wanted) else event == wanted:
            return events


def link_up(*buses: ZenohBus) -> None:
    """All announce themselves and know those that they are linked to."""
    for bus in buses:
        bus.links()
    names = {bus.name for bus in buses}
    until(lambda: all(bus._roll.has(bus.links() & names) and bus.links() for bus in buses), "all are linked")


def drives(events: list[BusEvent]) -> list[tuple[str, int]]:
    return [(e.key, e.message.tick) for e in events if isinstance(e, Delivery)]


def drive(tick: int, robot: int = 9) -> Drive:
    return Drive(robot, tick, 0.25, -0.25)


def line(wires: Wires, **options) -> list[ZenohBus]:
    """robot/1 - robot/2 - robot/3, each hears every drive that reaches it."""
    buses = [
        wires.member("robot/1", **options),
        wires.member("robot/2", "robot/1", **options),
        wires.member("robot/3", "robot/2", **options),
    ]
    for bus in buses:
        bus.subscribe("robot/*/drive", Drive)
    link_up(*buses)
    until(lambda: len(buses[1].links()) == 2, "the line is a line")
    return buses


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


class Server:
    """Answers all questions of a bus in a thread of its own."""

    def __init__(self, bus: ZenohBus, answer: Callable[[Asked], None]) -> None:
        self.asked: list[Message] = []
        self._bus, self._answer = bus, answer
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self) -> None:
        while not self._bus._closed:
            event = self._bus.receive(0.05)
            if isinstance(event, Asked):
                self.asked.append(event.message)
                self._answer(event)


def test_a_question_is_answered(wires: Wires) -> None:
    world, robot = wires.member("world"), wires.member("robot/1", "world")
    world.serve("robot/*/join", Ask)

    def answer(asked: Asked) -> None:
        asked.answer(Answer(True, asked.key))
        asked.answer(Answer(False, "a second answer goes nowhere"))

    server = Server(world, answer)
    for _ in range(3):
        assert robot.ask("robot/1/join", Ask(1), timeout=DEADLINE) == Answer(True, "robot/1/join")
    assert server.asked == [Ask(1)] * 3
    assert robot.counters.received == 3


def test_a_question_waits_for_who_can_answer_it(wires: Wires) -> None:
    robot = wires.member("robot/1", "world")
    assert robot.ask("scenario", Ask(1), timeout=0.1) is None
    replies: list[Message | None] = []
    asking = threading.Thread(target=lambda: replies.append(robot.ask("scenario", Ask(1), timeout=DEADLINE)))
    asking.start()
    world = wires.member("world")
    world.serve("scenario", Ask)
    Server(world, lambda asked: asked.answer(Answer(True, "{}")))
    asking.join(DEADLINE)
    assert replies == [Answer(True, "{}")]


def test_a_foreign_question_is_refused_and_a_foreign_reply_is_no_reply(wires: Wires) -> None:
    world = wires.member("world")
    stranger = wires.member("robot/2", "world", token=TOKEN + 1)
    robot = wires.member("robot/1", "world")
    world.serve("scenario", Ask)
    stranger.serve("robot/1/join", Ask)
    server = Server(world, lambda asked: asked.answer(Answer(True, "{}")))
    assert stranger.ask("scenario", Ask(2), timeout=1.0) is None
    assert robot.ask("scenario", Ask(1), timeout=DEADLINE) == Answer(True, "{}")
    assert server.asked == [Ask(1)]
    assert world.counters.refused >= 2  # it need not wait for the time-out to learn that nothing comes
    assert world.ask("robot/1/join", Ask(1), timeout=0.3) is None


def test_a_member_that_left_says_and_hears_nothing_and_leaves_nothing(wires: Wires) -> None:
    before = set(threading.enumerate())
    a, b = wires.member("robot/1"), wires.member("robot/2", "robot/1")
    a.subscribe("robot/2/drive", Drive)
    say = b.publisher("robot/2/drive", reliable=True)
    link_up(a, b)
    b.close()
    b.close()
    say(drive(1))
    assert b.links() == frozenset()
    assert not b.matched("robot/2/drive", [])
    assert b.ask("scenario", Ask(2), timeout=DEADLINE) is None
    assert [type(event) for event in (b.receive(None), b.receive(None), b.receive(1.0))][-1] is type(None)
    assert drives(await_event(a, Lost("robot/2"))) == []
    a.close()
    assert set(threading.enumerate()) <= before
    assert list(wires.folder.iterdir()) == []


def test_closing_wakes_whoever_still_waits(wires: Wires) -> None:
    a = wires.member("robot/1")
    heard: list[BusEvent | None] = []
    waiting = threading.Thread(target=lambda: heard.append(a.receive(None)))
    waiting.start()
    until(lambda: a._announced, "it waits")
    a.close()
    waiting.join(DEADLINE)
    assert heard == [None]


def test_an_endpoint_that_is_taken_is_told_in_a_sentence(wires: Wires) -> None:
    wires.member("robot/1")
    with pytest.raises(SwarmFailure, match=r"^robot/1 cannot listen at .*network\.endpoints\.$") as failure:
        wires.member("robot/1")
    assert ".rs:" not in str(failure.value)
    with pytest.raises(SwarmFailure, match="cannot join the run"):
        ZenohBus(RUN, "robot/3", TOKEN, listen=(), connect=["nonsense"])


def test_a_name_that_does_not_fit_is_told_in_a_sentence() -> None:
    with pytest.raises(ScenarioError, match="member's name"):
        ZenohBus(RUN, "robot/*", TOKEN, listen=(), connect=())
    with pytest.raises(ScenarioError, match="run's name"):
        ZenohBus("a/b", "world", TOKEN, listen=(), connect=())


def test_members_can_start_in_any_order(wires: Wires) -> None:
    last = wires.member("robot/2", "robot/1")
    last.subscribe("robot/1/drive", Drive)
    assert last.links() == frozenset()
    first = wires.member("robot/1")
    link_up(first, last)
    say = first.publisher("robot/1/drive", reliable=True)
    until(lambda: first.matched("robot/1/drive", ["robot/2"]), "linked")
    say(drive(3))
    assert drives(await_event(last, lambda e: isinstance(e, Delivery))) == [("robot/1/drive", 3)]


def test_the_threads_of_the_wires_keep_their_state_from_message_to_message(wires: Wires) -> None:
    """A thread without state of its own would begin to count anew with every message."""
    mine = threading.local()
    counts: list[int] = []

    class Counting:
        def offer(self, entry: object, frame: bytes) -> bool:
            mine.count = getattr(mine, "count", 0) + 1
            counts.append(mine.count)
            return True

        def push(self, entry: object) -> None:
            """Nobody takes anything out."""

    a, b = wires.member("robot/1"), wires.member("robot/2", "robot/1")
    link_up(a, b)
    a._inbox = Counting()
    a.subscribe("robot/2/drive", Drive)
    say = b.publisher("robot/2/drive", reliable=True)
    until(lambda: b.matched("robot/2/drive", ["robot/1"]), "a hears b")
    for tick in range(50):
        say(drive(tick))
    until(lambda: len(counts) == 50, "all are there")
    assert max(counts) > 10


# ---- processes ----


def echoed(bus: ZenohBus, say: Callable[[Message], None], tick: int) -> None:
    """Say something to robot/1 and hear it said back; repeated, for it may only just have come to life."""
    limit = time.monotonic() + DEADLINE
    while time.monotonic() < limit:
        say(drive(tick))
        event = bus.receive(0.1)
        while event is not None:
            if event == Delivery("robot/1/drive", Drive(9, tick + 1, 0.0, 0.0)):
                return
            event = bus.receive(0.1)
    raise AssertionError(f"not within {DEADLINE:g} s: an echo")


def talker(wires: Wires, **options) -> tuple[ZenohBus, Callable[[Message], None]]:
    bus = wires.member("robot/9", **options)
    bus.subscribe("robot/*/drive", Drive)
    return bus, bus.publisher("robot/9/drive", reliable=True)


@pytest.mark.processes
@unix_only
def test_a_killed_process_is_lost_and_may_come_back(wires: Wires) -> None:
    bus, say = talker(wires)
    for life in range(2):
        child = wires.process("robot/1", "robot/9")
        await_event(bus, Seen("robot/1"))
        echoed(bus, say, 10 * life)
        assert bus.links() == {"robot/1"}
        child.send_signal(signal.SIGKILL)
        await_event(bus, Lost("robot/1"))
        until(lambda: bus.links() == frozenset(), "the link is gone")
        assert child.stdout.read() == b""  # Zenoh says nothing by itself
    assert (wires.folder / "robot-1.sock").exists()  # left by SIGKILL, and no obstacle to the second life


@pytest.mark.processes
@unix_only
def test_a_frozen_process_is_lost_and_seen_again_when_it_goes_on(wires: Wires) -> None:
    bus, say = talker(wires)
    child = wires.process("robot/1", "robot/9")
    await_event(bus, Seen("robot/1"))
    echoed(bus, say, 1)
    child.send_signal(signal.SIGSTOP)
    assert await_event(bus, Lost("robot/1")) == [Lost("robot/1")]
    child.send_signal(signal.SIGCONT)
    await_event(bus, Seen("robot/1"))
    echoed(bus, say, 5)


@pytest.mark.processes
@unix_only
@pytest.mark.parametrize("reliable", [True, False])
def test_a_frozen_process_does_not_freeze_who_talks_to_it(wires: Wires, reliable: bool) -> None:
    """More than all queues and sockets hold; the reliable sender waits until the link is given up, and no longer."""
    bus = wires.member("robot/9")
    say = bus.publisher("robot/9/drive", reliable=reliable)
    flood = bus.publisher("robot/9/drive", reliable=reliable)
    child = wires.process("robot/1", "robot/9")
    until(lambda: bus.matched("robot/9/drive", ["robot/1"]), "linked")
    child.send_signal(signal.SIGSTOP)
    done = threading.Event()

    def talk() -> None:
        for tick in range(60_000):
            flood(drive(tick))
        done.set()

    threading.Thread(target=talk, daemon=True).start()
    assert done.wait(DEADLINE)
    await_event(bus, Lost("robot/1"))
    say(drive(1))


@pytest.mark.processes
@unix_only
def test_a_question_to_who_dies_or_never_answers_ends(wires: Wires) -> None:
    bus, _ = talker(wires)
    child = wires.process("robot/1", "robot/9")
    await_event(bus, Seen("robot/1"))
    assert bus.ask("robot/1/mute", Ask(9), timeout=0.2) is None
    replies: list[Message | None] = []
    asking = threading.Thread(target=lambda: replies.append(bus.ask("robot/1/mute", Ask(9), timeout=1.0)))
    asking.start()
    child.send_signal(signal.SIGKILL)
    asking.join(DEADLINE)
    assert replies == [None]


@pytest.mark.processes
@unix_only
def test_closing_does_not_wait_for_a_frozen_process(wires: Wires) -> None:
    bus, say = talker(wires, lease_ms=60_000)
    child = wires.process("robot/1", "robot/9")
    await_event(bus, Seen("robot/1"))
    echoed(bus, say, 1)
    child.send_signal(signal.SIGSTOP)
    closed = threading.Event()
    threading.Thread(target=lambda: (bus.close(), closed.set()), daemon=True).start()
    assert closed.wait(DEADLINE)
    with suppress(ProcessLookupError):
        child.send_signal(signal.SIGCONT)


@pytest.mark.processes
@unix_only
def test_a_second_process_of_the_same_name_waits_until_the_first_is_gone(wires: Wires) -> None:
    bus, say = talker(wires)
    first = wires.process("robot/1", "robot/9")
    await_event(bus, Seen("robot/1"))
    echoed(bus, say, 1)
    wires.endpoints["robot/1"] = unix_endpoint(wires.folder, "other")
    second = wires.process("robot/1", "robot/9")
    until((wires.folder / "other.sock").exists, "the second listens")
    echoed(bus, say, 5)
    assert bus.links() == {"robot/1"}
    first.send_signal(signal.SIGKILL)
    await_event(bus, Lost("robot/1"))
    await_event(bus, Seen("robot/1"))
    echoed(bus, say, 9)
    assert second.poll() is None
