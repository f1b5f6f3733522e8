"""The roll: which members are alive, as far as their liveliness tokens reach.

Rules: any thread may note; one change is one event, in the order of the changes. No clock, no sockets.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from threading import Lock

from protocol.bus import Lost, Seen


class Roll:
    """Who is alive; `tell` gets a `Seen` or `Lost` per change."""

    __slots__ = ("_alive", "_lock", "_tell")

    def __init__(self, tell: Callable[[Seen | Lost], None]) -> None:
        self._alive: set[str] = set()
        self._lock = Lock()
        self._tell = tell

    def note(self, name: str, alive: bool) -> None:
        """Note that a token of `name` came or went; what is known already is no event."""
        with self._lock:
            if (name in self._alive) == alive:
                return
            if alive:
                self._alive.add(name)
            else:
                self._alive.remove(name)
            self._tell(Seen(name) if alive else Lost(name))

    def has(self, names: Iterable[str]) -> bool:
        """Whether all of `names` are alive."""
        with self._lock:
            return self._alive.issuperset(names)
