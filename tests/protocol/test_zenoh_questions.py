"""Questions over Zenoh, members that come and leave, and what a person is told when one cannot.

Every wait is for a condition with a deadline.
"""

import threading
from collections.abc import Callable

import pytest
from zenoh_wires import DEADLINE, RUN, TOKEN, Wires, await_event, drive, drives, link_up, until

from protocol.bus import Asked, BusEvent, Delivery, Lost
from protocol.errors import ScenarioError, SwarmFailure
from protocol.messages import Answer, Ask, Drive, Message
from protocol.zenoh_bus import ZenohBus


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
