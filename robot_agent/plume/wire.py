"""The bytes of a flooded message: what its sender has, and some events.

    newest decision (u16, the rest of the number is the reader's own); what the sender has; events

What it has of the window up to a decision is told from the latest decision backwards, a bit for each robot, for as many
decisions as differ from the one before; older ones are as the last one told. When everything has come everywhere that is no
bit at all; robots that are silent cost no more than one decision's bits. In front of it stands a number (7 bits a byte, the
top bit: more follow): 0 when nothing is said, or 1 + decisions told times (window + 2) + how many decisions before `newest`
it ends. An event is its place (7 bits a byte: age times the number of robots plus the robot) and its record without the
robot.

Rules: whoever reads takes any bytes; what cannot be read ends the message.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from robot_agent.plume.events import NAME, SIZE, Key

BODY = SIZE - NAME


class Told(NamedTuple):
    """A message, read."""

    upto: int | None  # what the sender has is said up to this decision
    has: int  # of the window up to there: a bit for each robot, oldest decision lowest
    events: list[tuple[Key, bytes]]


class Wire:
    """Writes and reads the messages of a swarm."""

    def __init__(self, robots: int, window: int) -> None:
        self._robots, self._window = robots, window
        self._row = (1 << robots) - 1
        # Times a row: so many of it.
        self._ones = [sum(1 << n * robots for n in range(rows)) for rows in range(window + 1)]

    def write(
        self, newest: int, upto: int | None, oldest: int, has: int, events: Sequence[tuple[Key, bytes]]
    ) -> bytes:
        """A message; `upto`, `has` and `events` as in `Told`, all of them not later than `newest`.

        Args:
            oldest: what was before it is forgotten, and nobody asks for it.
        """
        parts = [(newest & 0xFFFF).to_bytes(2, "little")]
        if upto is None:
            parts.append(b"\0")
        else:
            rows = self._rows(upto, oldest, has)
            parts.append(_number(1 + len(rows) * (self._window + 2) + newest - upto))
            bits = 0
            for n, row in enumerate(rows):
                bits |= row << n * self._robots
            parts.append(bits.to_bytes((len(rows) * self._robots + 7) // 8, "little"))
        for (k, robot), record in events:
            parts += (_number((newest - k) * self._robots + robot), record[NAME:])
        return b"".join(parts)

    def read(self, message: bytes, now: int) -> Told | None:
        """`now`: about when it was written; None: it cannot be read at all."""
        if len(message) < 3:
            return None
        newest = now + ((int.from_bytes(message[:2], "little") - now + 0x8000) & 0xFFFF) - 0x8000
        said, at = _read_number(message, 2)
        upto, has = None, 0
        if said > 0:
            count, before = divmod(said - 1, self._window + 2)
            end = at + (count * self._robots + 7) // 8
            if count > self._window or end > len(message):
                return None
            upto, has = newest - before, self._spread(int.from_bytes(message[at:end], "little"), count)
            at = end
        events = []
        while at < len(message):
            place, at = _read_number(message, at)
            if len(message) < at + BODY or place < 0:
                break
            age, robot = divmod(place, self._robots)
            if age < self._window and age <= newest:  # there was no decision before 0
                events.append(((newest - age, robot), robot.to_bytes(NAME, "little") + message[at : at + BODY]))
            at += BODY
        return Told(upto, has, events)

    def _rows(self, upto: int, oldest: int, has: int) -> list[int]:
        """Rows to be told, the latest first: none when all are full. There was no decision before 0."""
        there = max(0, min(self._window, upto + 1, upto + 1 - oldest))
        rows = [has >> n * self._robots & self._row for n in range(self._window - 1, self._window - 1 - there, -1)]
        while len(rows) > 1 and rows[-1] == rows[-2]:
            rows.pop()
        return [] if rows == [self._row] else rows

    def _spread(self, bits: int, count: int) -> int:
        """The window of `count` rows told; older ones are as the last of them, or full."""
        last = bits >> (count - 1) * self._robots & self._row if count else self._row
        has = last * self._ones[self._window - count]
        for n in range(count):
            has |= (bits >> n * self._robots & self._row) << (self._window - 1 - n) * self._robots
        return has


def _number(n: int) -> bytes:
    """7 bits a byte, the low ones first."""
    parts = bytearray()
    while n > 127:
        parts.append(n & 127 | 128)
        n >>= 7
    parts.append(n)
    return bytes(parts)


def _read_number(message: bytes, at: int) -> tuple[int, int]:
    """The number at `at`, and where it ends; -1 when it does not end."""
    n = 0
    for shift in (0, 7, 14, 21):
        if at >= len(message):
            break
        byte = message[at]
        n, at = n | (byte & 127) << shift, at + 1
        if byte < 128:
            return n, at
    return -1, len(message)
