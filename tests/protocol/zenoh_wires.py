"""Members of a run over Zenoh for tests, objects of this process or processes, and waits that end."""

import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import pytest

from protocol.bus import BusEvent, Delivery, Seen
from protocol.endpoints import default_transport, free_tcp_endpoints, unix_endpoint
from protocol.messages import Drive, Message
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


def acquainted(wires: Wires, **options) -> tuple[ZenohBus, Callable[[Message], None], subprocess.Popen]:
    """A talker and the process robot/1 that has echoed it once."""
    bus, say = talker(wires, **options)
    child = wires.process("robot/1", "robot/9")
    await_event(bus, Seen("robot/1"))
    echoed(bus, say, 1)
    return bus, say, child
