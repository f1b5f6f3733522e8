"""Events flooded to all: the set of all events of the latest seconds, as a union that travels along the graph.

Rules: union is idempotent, commutative and associative: whatever is lost, late, double or comes in another order, robots
that have heard of the same events hold the same set; any jointly connected graph will do, directed ones too, without
weights. A message holds a bitmap of what its sender has (once a decision, and whenever that has changed), and the events
that a neighbour's latest bitmap lacks. Listeners that one cannot hear (directed graphs) are told each event again after 1,
2, 4 and 8 decisions. What is malformed, of no robot, or outside the window is left out; nothing raises.

    message: newest decision (u32); 0, or 1 + how many decisions before it a bitmap ends that follows (u8); the bitmap
    (window x robots bits); records, each with its age in front (u8)
"""

from __future__ import annotations

from collections.abc import Iterable

from robot_agent.plume.events import SIZE, Key, robot_of

AGAIN = (1, 2, 4, 8)  # decisions after which an event is told again to those who cannot answer
_HEAD = 5


class Flood:
    """One robot's set of events, and what it owes its neighbours."""

    def __init__(self, robots: int, window: int, hears: Iterable[int], linked: Iterable[int]) -> None:
        """`hears`: whose messages reach me; `linked`: those, and whom my messages reach."""
        self._robots, self._window = robots, window
        self._hears = frozenset(hears)
        self._alone = not set(linked) | self._hears
        self._deaf = bool(set(linked) - self._hears)
        self._map_bytes = (robots * window + 7) // 8
        self._now = 0
        self._known: dict[Key, bytes] = {}
        self._has: dict[int, set[Key]] = {j: set() for j in self._hears}  # what neighbours are known to have
        self._due: set[Key] = set()
        self._changed = False

    def clock(self, k: int) -> None:
        """Decision `k` is now: forget what is older than the window, and tell again what is to be told again."""
        self._now = k
        oldest = k - self._window
        self._known = {key: record for key, record in self._known.items() if key[0] > oldest}
        for has in self._has.values():
            has.intersection_update(self._known)
        self._due = {key for key in self._due if key[0] > oldest}
        if self._deaf:
            self._due |= {key for key in self._known if k - key[0] in AGAIN}

    def add(self, key: Key, record: bytes) -> bool:
        """Take an own event; whether it is new."""
        if key in self._known:
            return False
        self._known[key] = record
        self._due.add(key)
        return True

    def hear(self, robot: int, message: bytes) -> list[tuple[Key, bytes]]:
        """Take a neighbour's message; the events that are new."""
        if len(message) < _HEAD or robot not in self._hears:
            return []
        newest, at = int.from_bytes(message[:4], "little"), _HEAD
        has = self._has[robot]
        if message[4]:
            at += self._map_bytes
            bits = int.from_bytes(message[_HEAD:at], "little")
            upto = newest - (message[4] - 1)
            has -= {key for key in has if key[0] <= upto}
            has |= self._read(upto, bits)
            self._due |= {key for key in self._known if key not in has and upto - self._window < key[0] <= upto}
        new = []
        for start in range(at, len(message) - SIZE, SIZE + 1):
            age, record = message[start], message[start + 1 : start + 1 + SIZE]
            key = (newest - age, robot_of(record))
            if key[1] >= self._robots or age >= self._window or abs(key[0] - self._now) >= self._window:
                continue
            has.add(key)
            if key not in self._known:
                self._known[key] = record
                new.append((key, record))
        if new:
            self._changed = True
            if self._deaf:
                self._due |= {key for key, _ in new}
        return new

    def tell(self, refresh: bool) -> bytes:
        """The message of this tick; empty when there is nothing to say.

        Args:
            refresh: a decision has just been made: say what I have, whatever has changed.
        """
        if self._alone:
            return b""
        due = sorted(key for key in self._due if self._deaf or any(key not in has for has in self._has.values()))
        self._due.clear()
        if not (due or refresh or self._changed):
            return b""
        newest = max(self._now, due[-1][0] if due else 0)
        parts = [newest.to_bytes(4, "little")]
        if refresh or self._changed:
            # At a decision the others' events of now are still under way: nothing is said about this one.
            upto = self._now - 1 if refresh else newest
            parts.append(bytes((1 + newest - upto,)))
            parts.append(self._write(upto))
            self._changed = False
        else:
            parts.append(b"\0")
        for key in due:
            if newest - key[0] < self._window:
                parts += (bytes((newest - key[0],)), self._known[key])
        return b"".join(parts)

    def _write(self, upto: int) -> bytes:
        bits = 0
        for k, robot in self._known:
            if upto - self._window < k <= upto:
                bits |= 1 << (upto - k) * self._robots + robot
        return bits.to_bytes(self._map_bytes, "little")

    def _read(self, upto: int, bits: int) -> set[Key]:
        keys = set()
        while bits:
            low = bits & -bits
            age, robot = divmod(low.bit_length() - 1, self._robots)
            keys.add((upto - age, robot))
            bits ^= low
        return keys
