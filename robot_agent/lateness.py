"""How late a reading is, told by the robot's own clock alone.

Rules: pure; the time is an argument. The clocks of world and robot need not agree: reading k is expected `k` periods
after some start, and the start is read off the promptest of the last readings. What the world says to have moved in its
schedule is no lateness.
"""

from __future__ import annotations

from collections import deque

WINDOW = 64  # readings that the start is read off


class Lateness:
    """Remembers when the last readings came."""

    __slots__ = ("_period", "_starts")

    def __init__(self, period: float) -> None:
        """`period`: between two readings, wall-clock s."""
        self._period = period
        self._starts: deque[float] = deque(maxlen=WINDOW)

    def of(self, tick: int, slip: float, now: float) -> float:
        """How much later than the promptest of the last ones the reading of `tick` is, s, when it is used at `now`."""
        start = now - slip - tick * self._period
        self._starts.append(start)
        return start - min(self._starts)
