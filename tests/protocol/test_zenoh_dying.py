"""Members over Zenoh that are processes and are killed or stopped: nobody hangs with a peer that hangs.

Every wait is for a condition with a deadline.
"""

import signal
import threading
from contextlib import suppress

import pytest
from zenoh_wires import DEADLINE, Wires, acquainted, await_event, drive, echoed, talker, unix_only, until

from protocol.bus import Lost, Seen
from protocol.endpoints import unix_endpoint
from protocol.messages import Ask, Message


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
    bus, say, child = acquainted(wires)
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
    bus, _, child = acquainted(wires, lease_ms=60_000)
    child.send_signal(signal.SIGSTOP)
    closed = threading.Event()
    threading.Thread(target=lambda: (bus.close(), closed.set()), daemon=True).start()
    assert closed.wait(DEADLINE)
    with suppress(ProcessLookupError):
        child.send_signal(signal.SIGCONT)


@pytest.mark.processes
@unix_only
def test_a_second_process_of_the_same_name_waits_until_the_first_is_gone(wires: Wires) -> None:
    bus, say, first = acquainted(wires)
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
