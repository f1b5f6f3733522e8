"""Truth messages as arrays.

Rules: pure; a message that does not fit the scenario is left out and counted, it never raises.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from protocol.messages import Truth

Floats = NDArray[np.float64]
Ticks = NDArray[np.int64]

X, Y, THETA, NU, OMEGA, TAU_LEFT, TAU_RIGHT, PPT, ALIVE = range(9)
COLUMNS = 9


@dataclass(frozen=True, slots=True)
class Track:
    """K states of N robots, in the order of time."""

    ticks: Ticks  # (K,)
    t: Floats  # (K,), s
    robots: Floats  # (K, N, 9), see the columns above

    def __len__(self) -> int:
        return self.t.size

    def __getitem__(self, rows: slice) -> Track:
        return Track(self.ticks[rows], self.t[rows], self.robots[rows])

    def then(self, later: Track) -> Track:
        """This and `later`, which begins when this has ended."""
        pairs = zip(self._columns(), later._columns(), strict=True)
        return Track(*(np.concatenate(pair) for pair in pairs))

    def last(self, seconds: float) -> Track:
        """The last `seconds` of this."""
        since = int(np.searchsorted(self.t, self.t[-1] - seconds)) if len(self) else 0
        return self[since:]

    def _columns(self) -> tuple[Ticks, Floats, Floats]:
        return self.ticks, self.t, self.robots

    @property
    def points(self) -> Floats:
        """Positions, (K, N, 2), m."""
        return self.robots[:, :, X : Y + 1]

    @property
    def alive(self) -> NDArray[np.bool_]:
        """Who lives, (K, N)."""
        return self.robots[:, :, ALIVE] > 0.0


def track_of(truths: Sequence[Truth], n: int) -> tuple[Track, int]:
    """The states in `truths` of `n` robots, and how many messages did not fit."""
    size = n * COLUMNS * 8
    good = sorted((truth for truth in truths if len(truth.robots) == size), key=lambda truth: truth.tick)
    robots = np.frombuffer(b"".join(truth.robots for truth in good), dtype="<f8").reshape(
        len(good), n, COLUMNS
    )
    ticks = np.array([truth.tick for truth in good], dtype=np.int64)
    t = np.array([truth.t for truth in good], dtype=np.float64)
    return Track(ticks, t, robots), len(truths) - len(good)


class Gaps:
    """Counts the truth messages that were sent and never arrived, by their running numbers."""

    __slots__ = ("_highest", "_received")

    def __init__(self) -> None:
        self._highest = -1
        self._received = 0

    def take(self, truths: Sequence[Truth]) -> None:
        """Count messages that arrived, in any order."""
        self._received += len(truths)
        self._highest = max(self._highest, *(truth.count for truth in truths), -1)

    @property
    def sent(self) -> int:
        """Messages that the world must have sent."""
        return max(self._highest + 1, self._received)

    @property
    def lost(self) -> int:
        """Of those, how many did not arrive."""
        return self.sent - self._received
