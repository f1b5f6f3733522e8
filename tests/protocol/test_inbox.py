"""The queue between wires and member: bounded, in order, never in the sender's way."""

import signal
import sys
import threading

import pytest

from protocol import inbox as module
from protocol.bus import Counters, Lost
from protocol.inbox import BIG_FRAME, Inbox

SMALL, BIG = b"x", bytes(BIG_FRAME + 1)


class Called(Exception):
    """Raised by a signal handler."""


def test_entries_come_out_in_order_and_none_when_there_is_none() -> None:
    inbox = Inbox(Counters())
    for k in range(3):
        inbox.offer(k, SMALL)
    assert [inbox.take(timeout) for timeout in (None, 0, 5.0, 0, 0.001)] == [0, 1, 2, None, None]


def test_a_flood_loses_its_newest_entries_and_no_event(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MAX_ENTRIES", 10)
    counters = Counters()
    inbox = Inbox(counters)
    assert [inbox.offer(k, SMALL) for k in range(15)] == [True] * 10 + [False] * 5
    inbox.push(Lost("world"))
    assert counters.dropped == 5
    assert [inbox.take(0) for _ in range(12)] == [*range(10), Lost("world"), None]
    assert inbox.offer("again", SMALL)


def test_big_frames_have_less_room_until_they_are_taken_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MAX_BIG_BYTES", 2 * len(BIG))
    counters = Counters()
    inbox = Inbox(counters)
    assert [inbox.offer(k, BIG) for k in range(3)] == [True, True, False]
    assert inbox.offer("small", SMALL)
    assert counters.dropped == 1
    inbox.take(0)
    inbox.release(BIG)
    assert inbox.offer("big", BIG)


@pytest.mark.skipif(sys.platform == "win32", reason="needs setitimer")
@pytest.mark.parametrize("timeout", [None, 60.0])
def test_a_signal_handler_interrupts_the_wait(timeout: float | None) -> None:
    def call(signum: int, frame: object) -> None:
        raise Called

    before = signal.signal(signal.SIGALRM, call)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        with pytest.raises(Called):
            Inbox(Counters()).take(timeout)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_many_threads_can_offer_at_once() -> None:
    inbox = Inbox(Counters())
    threads = [threading.Thread(target=lambda: [inbox.offer(k, SMALL) for k in range(500)]) for _ in range(4)]
    for thread in threads:
        thread.start()
    taken = [inbox.take(10.0) for _ in range(2000)]
    assert sorted(taken) == sorted([*range(500)] * 4)
    assert inbox.take(0) is None
