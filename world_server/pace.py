"""When the world of a real-time run steps: the schedule on the wall clock.

Rules: pure; the time is an argument, in s of any clock that only goes on. Steps stand at fixed places of the clock, so
that no step's lateness adds to the next one's. A world that is a little behind catches up, at twice the pace at most:
a burst of readings would be of no use to anybody. What is further behind is given up: the rest of the schedule moves,
and `slip` says by how much in all.
"""

from __future__ import annotations

CATCH_UP_PACE = 2.0  # steps per period while catching up


class Pace:
    """The schedule of the steps from tick k to k + 1, k = 0, 1, ..."""

    __slots__ = ("_catch_up", "_earliest", "behind", "due", "period", "slip")

    def __init__(self, start: float, period: float, catch_up: float) -> None:
        """`start`: when tick 0 is; `period`: between two ticks, s; `catch_up`: most that is ever caught up with, s."""
        self.period = period
        self.due = start + period  # when the next step belongs
        self.slip = 0.0  # by how much the schedule has been moved, s
        self.behind = 0.0  # largest lateness of any step, s
        self._catch_up = catch_up
        self._earliest = start

    def wait(self, now: float) -> float:
        """How long the next step has to wait, s; 0: step now."""
        return max(0.0, max(self.due, self._earliest) - now)

    def step(self, now: float) -> float:
        """A step is made at `now`; by how much that moves the schedule, s."""
        late = max(0.0, now - self.due)
        self.behind = max(self.behind, late)
        moved = late - self._catch_up if late > self._catch_up else 0.0
        self.slip += moved
        self.due += moved + self.period
        self._earliest = now + self.period / CATCH_UP_PACE
        return moved
