"""A map of where the source may be: the logarithm of its probability on a grid over the arena.

Rules: pure; plain floats; a report touches only the cells near the way that odour took to the robot, so that a map costs
little. A report of robot j at time t: what it smelt at x_j, and where the air that is there now was before, a line of
points with their lags. A source near that line at lag l would be smelt with the probability
    q = false + hit g,   g = exp(-d^2 / (2 s^2)),   s^2 = width^2 + spread^2 l,
d the distance of the cell from the line. By Bayes' rule a report of odour adds log(q / false) to the cell, one of clean air
log((1 - q) / (1 - false)).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import ceil, exp, hypot, log

from protocol.scenario.laws import Lpso
from protocol.scenario.sections import Arena
from robot_agent.interfaces import Point

Place = tuple[float, float, float]  # lag, s; x, y, m
REACH = 3.0  # cells further from the line than this many s are left alone


class SourceMap:
    """Log-probability of the cells, up to a constant; even at first."""

    def __init__(self, arena: Arena, p: Lpso) -> None:
        self._p = p
        self._x, self._y, self._cell = arena.x_min, arena.y_min, p.cell
        self._nx = max(1, ceil((arena.x_max - arena.x_min) / p.cell - 1e-9))
        self._ny = max(1, ceil((arena.y_max - arena.y_min) / p.cell - 1e-9))
        self.log = [0.0] * (self._nx * self._ny)  # cell (i, j) at i ny + j

    def centre(self, n: int) -> Point:
        """Middle of cell n, m."""
        i, j = divmod(n, self._ny)
        return self._x + (i + 0.5) * self._cell, self._y + (j + 0.5) * self._cell

    def learn(self, line: Sequence[Place], smelt: bool, weight: float = 1.0) -> None:
        """Take a report in.

        Args:
            line: where the air that was smelt came from, the latest first, rising lags.
            weight: what the report counts, 0 to 1.
        """
        for one, two in pairwise(line):
            if abs(two[1] - one[1]) >= abs(two[2] - one[2]):
                self._along(one, two, smelt, weight, True)
            else:
                self._along((one[0], one[2], one[1]), (two[0], two[2], two[1]), smelt, weight, False)

    def _along(self, one: Place, two: Place, smelt: bool, weight: float, by_x: bool) -> None:
        """Visit the cells along a stretch that runs mainly along its first axis; the other way round when not `by_x`."""
        p, cell = self._p, self._cell
        run, rise = two[1] - one[1], two[2] - one[2]
        if run == 0.0:
            return
        cosine = abs(run) / hypot(run, rise)
        clean = min(0.999, p.hit / (1.0 - p.false))
        low, n, low_v, n_v = (self._x, self._nx, self._y, self._ny) if by_x else (self._y, self._ny, self._x, self._nx)
        # Columns whose middle lies in [one, two): every column is visited once by a line that does not turn back.
        first, last = sorted((ceil((one[1] - low) / cell - 0.5), ceil((two[1] - low) / cell - 0.5)))
        for i in range(max(0, first), min(n, last)):
            part = (low + (i + 0.5) * cell - one[1]) / run
            v = one[2] + part * rise
            s2 = p.width**2 + p.spread**2 * (one[0] + part * (two[0] - one[0]))
            half = REACH * s2**0.5 / cosine
            start = max(0, ceil((v - half - low_v) / cell - 0.5))
            stop = min(n_v, ceil((v + half - low_v) / cell - 0.5))
            for j in range(start, stop):
                d = (low_v + (j + 0.5) * cell - v) * cosine
                g = exp(-0.5 * d * d / s2)
                gain = log(1.0 + g * p.hit / p.false) if smelt else log(1.0 - g * clean)
                self.log[i * self._ny + j if by_x else j * self._ny + i] += weight * gain

    def forget(self, factor: float) -> None:
        """Let all that was learnt count `factor` times as much from now on."""
        self.log = [factor * each for each in self.log]

    def weights(self) -> list[float]:
        """Probabilities of the cells, up to a factor; the largest is 1."""
        top = max(self.log)
        return [exp(each - top) for each in self.log]

    def best(self) -> Point:
        """Middle of the most probable cell; the mean of those that are equally probable, m."""
        top = max(self.log)
        return self._mean([1.0 if each == top else 0.0 for each in self.log])[0]

    def mean(self) -> tuple[Point, float]:
        """Mean place of the source, m, and its mean variance per axis, m^2."""
        return self._mean(self.weights())

    def drawn(self, u: float) -> Point:
        """The cell at which the cumulated probability passes u, 0 <= u < 1; a draw from the map when u is one."""
        weights = self.weights()
        left = u * sum(weights)
        for n, w in enumerate(weights):
            left -= w
            if left < 0.0:
                return self.centre(n)
        return self.centre(len(weights) - 1)

    def _mean(self, weights: Sequence[float]) -> tuple[Point, float]:
        ny = self._ny
        rows = [sum(weights[i * ny : (i + 1) * ny]) for i in range(self._nx)]
        columns = [sum(weights[j::ny]) for j in range(ny)]
        x, xx = _moments(rows)
        y, yy = _moments(columns)
        cell = self._cell
        mean = (self._x + (x + 0.5) * cell, self._y + (y + 0.5) * cell)
        return mean, 0.5 * (xx + yy) * cell * cell + cell * cell / 12.0


def _moments(weights: Sequence[float]) -> tuple[float, float]:
    """Mean and variance of an index with these weights."""
    total = sum(weights)
    mean = sum(i * w for i, w in enumerate(weights)) / total
    return mean, sum((i - mean) ** 2 * w for i, w in enumerate(weights)) / total
