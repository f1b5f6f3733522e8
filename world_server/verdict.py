"""Who found the source, and how close the robots came to each other.

Rules: judged along the ways of the hands, straight between substeps; an arrival is where the way enters the circle of
`source.radius`, so its time does not hang on the tick or the substep. Once found, the finder stays. With `source.stop` =
"concentration" (chapter 2) it is not the place that counts but what the sensors meet, at the instants when they sample.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from protocol.scenario.sections import Source
from world_server.bodies import Path
from world_server.snapshot import VerdictState, pack, unpack

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


class Found(NamedTuple):
    """The first arrival, or the first sample of enough odour."""

    robot: int
    t: float  # s


class Verdict:
    """What can be said of the run so far."""

    def __init__(self, source: Source | None, hands: Array) -> None:
        """Robots stand with their hands at `hands`, shape (N, 2), m, at t = 0; without a source nobody ever arrives."""
        self.found: Found | None = None
        self._source = complex(source.x, source.y) if source else 0j
        self._radius = source.radius if source else 0.0
        self._by_place = source is not None and source.stop == "circle"
        self._ppt = source.stop_concentration if source and not self._by_place else math.inf
        self._first, self._second = np.triu_indices(len(hands), 1)  # all pairs of robots
        self._pair2 = math.inf
        # How far the hands may still go before a look is worth its time: nobody can arrive, no pair beat the record.
        self._source_slack = 0.0 if self._by_place else math.inf
        self._pair_slack = 0.0
        here = [[complex(x, y)] for x, y in hands.tolist()]  # ways of one point each
        self.judge(Path(here, [0.0] * len(here), 0.0), 0.0)

    @property
    def min_pair_distance(self) -> float | None:
        """Smallest distance of two hands so far, at the ends of substeps, m; None with one robot."""
        return math.sqrt(self._pair2) if self._first.size else None

    @property
    def state(self) -> VerdictState:
        """All that the coming ticks need."""
        return VerdictState(self.found, pack([self._pair2, self._source_slack, self._pair_slack]))

    def restore(self, state: VerdictState) -> None:
        """Go on from `state`."""
        self.found = Found(*state.found) if state.found else None
        self._pair2, self._source_slack, self._pair_slack = unpack(state.numbers, 3).tolist()

    def judge(self, path: Path, t0: float) -> None:
        """Take in the tick that began at `t0`, s."""
        longest = max(path.ways)
        if self.found is None:
            self._source_slack -= longest
            if self._source_slack <= 0.0:
                self._look_at_source(path, t0, longest)
        self._pair_slack -= 2.0 * longest
        if self._pair_slack <= 0.0 and self._first.size:
            self._look_at_pairs(path.track, 2.0 * longest)

    def smell(self, ppt: Sequence[float], t: float, live: Collection[int]) -> None:
        """Take in what the sensors meet at time `t`, s; of two that meet enough at once the one with more finds.

        Args:
            ppt: concentration at every robot's hand, ppt.
            live: the robots that still sense.
        """
        if self.found is None and max(ppt) >= self._ppt:
            enough = [i for i in sorted(live) if ppt[i] >= self._ppt]
            if enough:
                self.found = Found(max(enough, key=lambda i: ppt[i]), t)

    def _look_at_source(self, path: Path, t0: float, longest: float) -> None:
        last = min(abs(row[-1] - self._source) for row in path.rows)
        if last <= self._radius + 2.0 * longest:
            self.found = first_arrival(path.track, self._source, self._radius, t0, path.h)
        self._source_slack = last - self._radius

    def _look_at_pairs(self, track: Complex, approach: float) -> None:
        """Look closer at the pairs that may have beaten the record, having moved by `approach` at most, m."""
        first, second, last = self._first, self._second, track[:, -1]
        limit = math.sqrt(self._pair2) + approach
        distance2 = _square(last[first] - last[second])
        near = np.flatnonzero(distance2 <= limit * limit)
        if near.size:
            pair2 = _square(track[first[near]] - track[second[near]])
            self._pair2 = min(self._pair2, float(np.minimum.reduce(pair2, axis=None)))
        self._pair_slack = math.sqrt(float(np.minimum.reduce(distance2))) - math.sqrt(self._pair2)


def first_arrival(track: Complex, source: complex, radius: float, t0: float, h: float) -> Found | None:
    """First robot whose way enters the circle, and when; of two at the same time the lower number.

    On the way p + s d, 0 <= s <= 1, from one end of a substep to the next, |p + s d - source|^2 = radius^2.

    Args:
        track: x + i y at t0, t0 + h, ..., shape (N, S + 1), m.
    """
    best: Found | None = None
    for robot, row in enumerate(track):
        t = _entry(row - source, radius)
        if t is not None and (best is None or t0 + t * h < best.t):
            best = Found(robot, t0 + t * h)
    return best


def _entry(way: Complex, radius: float) -> float | None:
    """How many substeps, a real number, until `way` about the centre enters the circle; None when it does not."""
    ends: list[complex] = way.tolist()
    if abs(ends[0]) <= radius:
        return 0.0
    for s, (p, q) in enumerate(pairwise(ends)):
        d = q - p
        a, b, c = abs(d) ** 2, (p * d.conjugate()).real, abs(p) ** 2 - radius**2
        discriminant = b * b - a * c
        if b < 0.0 and discriminant >= 0.0:
            part = c / (-b + math.sqrt(discriminant))  # the smaller root of a s^2 + 2 b s + c, without cancellation
            if part <= 1.0:
                return s + max(part, 0.0)
        if abs(q) <= radius:  # rounding at the rim
            return s + 1.0
    return None


def _square(z: Complex) -> Array:
    """|z|^2 without a root."""
    x, y = z.real, z.imag
    return x * x + y * y
