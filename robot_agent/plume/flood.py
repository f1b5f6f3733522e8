"""Events flooded to all: the set of all events of the latest seconds, as a union that travels along the graph.

Rules: union is idempotent, commutative and associative: whatever is lost, late, double or comes in another order, robots
that have heard of the same events hold the same set; any jointly connected graph will do, directed ones too, without
weights. A message says what its sender has (once a decision, and whenever that has changed), and brings the events that a
neighbour's latest saying lacks; nobody is told what it is known to have, and of two who could pass an event on only those
do that a neighbour waits for. Listeners that one cannot hear (directed graphs) are told each event again after 1, 2, 4 and 8
decisions. What is malformed, of no robot, or outside the window is left out; nothing raises.

The message is `robot_agent.plume.wire`'s. Sets are kept as whole numbers, a bit for each event: decision - oldest, times the
number of robots, plus the robot.
"""

from __future__ import annotations

from collections.abc import Iterable

from robot_agent.plume.events import Key
from robot_agent.plume.wire import Wire

AGAIN = (1, 2, 4, 8)  # decisions after which an event is told again to those who cannot answer


class Flood:
    """One robot's set of events, and what it owes its neighbours."""

    def __init__(self, robots: int, window: int, hears: Iterable[int], reaches: Iterable[int]) -> None:
        """`hears`: whose messages reach me; `reaches`: whom mine reach."""
        self._robots, self._window = robots, window
        self._wire = Wire(robots, window)
        self._row = (1 << robots) - 1
        self._hears, reached = frozenset(hears), frozenset(reaches)
        self._has = dict.fromkeys(sorted(reached & self._hears), 0)  # what those are known to have who can ask me for more
        self._alone = not reached
        self._deaf = bool(reached - self._hears)
        # Who cannot answer has its own events, and nobody knows what else.
        silent = reached - self._hears
        lacked = sum(1 << i for i in range(robots) if silent - {i})
        self._unknown = sum(lacked << row * robots for row in range(2 * window))
        self._now = 0
        self._oldest = 1 - window  # decision of the lowest bits
        self._known: dict[Key, bytes] = {}
        self._mine = 0  # the same as a set
        self._due = 0
        self._changed = False

    def clock(self, k: int) -> None:
        """Decision `k` is now: forget what is older than the window, and tell again what is to be told again."""
        self._now = k
        passed = k - self._window + 1 - self._oldest
        self._oldest += passed
        self._known = {key: record for key, record in self._known.items() if 0 <= key[0] - self._oldest < 2 * self._window}
        if passed >= 0:
            gone = passed * self._robots
            self._mine, self._due = self._mine >> gone, self._due >> gone
            self._has = {robot: has >> gone for robot, has in self._has.items()}
        else:  # a clock was set back: what neighbours have they will say again
            self._mine, self._due = sum(map(self._bit, self._known)), 0
            self._has = dict.fromkeys(self._has, 0)
        if self._deaf:
            for age in AGAIN:
                if age < self._window:
                    self._due |= self._mine & self._row << (k - age - self._oldest) * self._robots

    def add(self, key: Key, record: bytes) -> bool:
        """Take an own event; whether it is new."""
        if key in self._known or abs(key[0] - self._now) >= self._window:
            return False
        self._keep(key, record)
        self._due |= self._bit(key)
        return True

    def hear(self, robot: int, message: bytes) -> list[tuple[Key, bytes]]:
        """Take a neighbour's message; the events that are new."""
        if robot not in self._hears:
            return []
        told = self._wire.read(message, self._now)
        if told is None:
            return []
        if robot in self._has and told.upto is not None and abs(told.upto - self._now) < 2 * self._window:
            self._owe(robot, told.upto, told.has)
        new = []
        for key, record in told.events:
            if abs(key[0] - self._now) >= self._window:
                continue
            if robot in self._has:
                self._has[robot] |= self._bit(key)
            if key not in self._known:
                self._keep(key, record)
                new.append((key, record))
                if self._deaf:
                    self._due |= self._bit(key)
        self._changed |= bool(new)
        return new

    def tell(self, refresh: bool) -> bytes:
        """The message of this tick; empty when there is nothing to say.

        Args:
            refresh: a decision has just been made: say what I have, whatever has changed.
        """
        says = bool(self._has) and (refresh or self._changed)  # to whoever can answer
        if self._alone or not (self._due or says):
            return b""
        due, self._due = self._due & self._lacking(), 0
        if not (due or says):
            return b""
        events = self._keys(due)
        newest = max(self._now, events[-1][0] if events else 0)
        events = [key for key in events if newest - key[0] < self._window]
        upto = None
        if says:
            # At a decision the others' events of now are still under way: nothing is said about this one.
            upto = self._now - 1 if refresh else newest
            self._changed = False
        told = [(key, self._known[key]) for key in events]
        return self._wire.write(newest, upto, self._oldest, self._window_of(self._mine, upto), told)

    def _keep(self, key: Key, record: bytes) -> None:
        self._known[key] = record
        self._mine |= self._bit(key)

    def _owe(self, robot: int, upto: int, has: int) -> None:
        """A neighbour has said what it has of the window up to `upto`."""
        first = upto - self._window + 1 - self._oldest  # of that window, counted from my oldest
        has, all_of_it = self._moved(has, -first), self._moved((1 << self._window * self._robots) - 1, -first)
        said = max(0, first + self._window) * self._robots
        self._has[robot] = has | self._has[robot] >> said << said  # of later events it has said nothing
        self._due |= self._mine & all_of_it & ~has

    def _lacking(self) -> int:
        """What somebody who hears me may not have."""
        common = -1
        for has in self._has.values():
            common &= has
        return ~common | self._unknown

    def _window_of(self, events: int, upto: int | None) -> int:
        """Of a set, the bits of the window up to `upto`."""
        if upto is None:
            return 0
        return self._moved(events, upto - self._window + 1 - self._oldest) & (1 << self._window * self._robots) - 1

    def _bit(self, key: Key) -> int:
        return 1 << (key[0] - self._oldest) * self._robots + key[1]

    def _keys(self, events: int) -> list[Key]:
        """What of a set is known, oldest first."""
        keys = []
        while events > 0:
            place = (events & -events).bit_length() - 1
            events &= events - 1
            key = self._oldest + place // self._robots, place % self._robots
            if key in self._known:
                keys.append(key)
        return keys

    def _moved(self, events: int, by: int) -> int:
        """A set as counted from `by` decisions later; what is earlier is gone."""
        return events >> by * self._robots if by >= 0 else events << -by * self._robots
