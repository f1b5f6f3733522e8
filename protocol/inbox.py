"""The queue between the threads of the wires and the one thread of the member.

Rules: `offer` never waits: what does not fit is counted and dropped, so that a flood costs messages and not the
machine's memory, nor the liveness of the other links. `take` hands out in order of arrival and can be interrupted by a
signal handler. Entries are opaque here; frames are opened in the member's own thread.
"""

from __future__ import annotations

import sys
from queue import Empty, SimpleQueue
from threading import Lock
from typing import Any

from protocol.bus import Counters

MAX_ENTRIES = 50_000  # waiting at a time
BIG_FRAME = 4096  # bytes
MAX_BIG_BYTES = 256 << 20  # of big frames, waiting at a time
# Windows does not run signal handlers while a lock is waited for.
_PATIENCE = 0.2 if sys.platform == "win32" else None  # s


class Inbox:
    """A bounded queue of frames, and of events that are never dropped."""

    __slots__ = ("_big", "_counters", "_get", "_lock", "_put", "_size")

    def __init__(self, counters: Counters) -> None:
        entries: SimpleQueue[Any] = SimpleQueue()
        self._counters = counters
        self._get, self._put, self._size = entries.get, entries.put, entries.qsize
        self._big = 0  # bytes of big frames waiting
        self._lock = Lock()  # of _big; small frames need none

    def offer(self, entry: Any, frame: bytes) -> bool:
        """Queue `entry`, which holds `frame`, if there is room; whether there was."""
        if self._size() >= MAX_ENTRIES or (len(frame) > BIG_FRAME and not self._room_for_big(len(frame))):
            self._counters.dropped += 1
            return False
        self._put(entry)
        return True

    def push(self, entry: Any) -> None:
        """Queue `entry` always."""
        self._put(entry)

    def release(self, frame: bytes) -> None:
        """Say that `frame`, of more than `BIG_FRAME` bytes, was taken out and opened."""
        with self._lock:
            self._big -= len(frame)

    def take(self, timeout: float | None) -> Any:
        """Next entry; None after `timeout` seconds without one (None: wait for ever, 0: do not wait)."""
        try:
            if timeout is None:
                if _PATIENCE is None:
                    return self._get()
                while True:
                    try:
                        return self._get(True, _PATIENCE)
                    except Empty:
                        continue
            return self._get(True, timeout) if timeout > 0 else self._get(False)
        except Empty:
            return None

    def _room_for_big(self, size: int) -> bool:
        with self._lock:
            if self._big + size > MAX_BIG_BYTES:
                return False
            self._big += size
            return True
