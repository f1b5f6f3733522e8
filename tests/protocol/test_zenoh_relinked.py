"""Links that end and come back while the peer is held up: nothing may arrive under another key than it was sent under.

The peer is stopped until its listeners have given it up and knock again; when it goes on it finds the ends of the old
links and the new ones at the same time, and Zenoh may take a new one for one more of the old link.
"""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from protocol.bus import Delivery, Lost
from protocol.endpoints import default_transport, unix_endpoint
from protocol.messages import Drive
from protocol.zenoh_bus import ZenohBus, token_of

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(default_transport() != "unix", reason="needs unix sockets and signals"),
]
RUN, KEYS, LISTENERS, LEASE_MS, STOPS = "again", 12, 8, 100, 20
DEADLINE = 30.0  # s
ROOT = Path(__file__).parents[2]


class Listener:
    """A member in this process that hears all keys of the speaker."""

    def __init__(self, i: int, endpoint: str) -> None:
        self.heard = self.lost = 0
        self.misled: list[str] = []
        self.bus = ZenohBus(RUN, f"robot/{i}", token_of(RUN), listen=(), connect=[endpoint], lease_ms=LEASE_MS)
        for k in range(KEYS):
            self.bus.subscribe(f"robot/{k}/drive", Drive)

    def listen(self) -> None:
        while (event := self.bus.receive(0)) is not None:
            if isinstance(event, Delivery):
                self.heard += 1
                if event.key != f"robot/{event.message.robot}/drive":
                    self.misled.append(f"{event.message.robot} under {event.key}")
            elif isinstance(event, Lost):
                self.lost += 1


def until(condition: Callable[[], bool], listeners: list[Listener], what: str) -> None:
    end, pause = time.monotonic() + DEADLINE, threading.Event()
    while not condition():
        assert time.monotonic() < end, f"not within {DEADLINE:g} s: {what}"
        for listener in listeners:
            listener.listen()
        pause.wait(0.002)


def test_nothing_arrives_under_a_wrong_key_when_links_come_back_to_a_peer_that_was_held_up() -> None:
    with tempfile.TemporaryDirectory(prefix="t-") as folder:
        endpoint = unix_endpoint(Path(folder), "world")
        command = [sys.executable, str(Path(__file__).with_name("zenoh_speaker.py"))]
        speaker = subprocess.Popen(
            [*command, RUN, "world", str(LEASE_MS), str(KEYS), endpoint],
            env={**os.environ, "PYTHONPATH": str(ROOT)},
        )
        listeners = [Listener(i, endpoint) for i in range(LISTENERS)]
        try:
            for stop in range(1, STOPS + 1):
                before = [listener.heard for listener in listeners]

                def all_hear(before: list[int] = before) -> bool:
                    return all(x.heard >= n + 5 * KEYS for x, n in zip(listeners, before, strict=True))

                until(all_hear, listeners, "all hear the speaker")
                speaker.send_signal(signal.SIGSTOP)
                until(lambda stop=stop: all(x.lost >= stop for x in listeners), listeners, "all have given it up")
                knocked = time.monotonic() + 0.01 * (stop % 5)  # nobody sees them knock: as long as that takes, or not
                until(lambda knocked=knocked: time.monotonic() > knocked, listeners, "they have knocked")
                speaker.send_signal(signal.SIGCONT)
            until(lambda: all(x.bus.links() for x in listeners), listeners, "all are linked again")
        finally:
            speaker.kill()
            speaker.wait(DEADLINE)
            for listener in listeners:
                listener.bus.close()
        assert [listener.misled for listener in listeners] == [[] for _ in listeners]
        assert [listener.bus.counters.refused for listener in listeners] == [0] * LISTENERS
