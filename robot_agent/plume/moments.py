"""Sums over lines of cells: the mass of exp(L), and its first two moments.

A line is i, the j of its cells, their values of the map and the greatest of these; i and j are of fine cells. Of the cells
those count that are no more than `CUT` below the best one.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import exp
from operator import itemgetter
from typing import NamedTuple

CUT = 9.0  # nats

Moments = tuple[float, float, float, float, float]  # mean x, y, covariance xx, xy, yy, in cells
Line = tuple[int, Sequence[float], Sequence[float], float]


class Sums(NamedTuple):
    """Of w = exp(L - L_best) over cells (x, y)."""

    w: float
    wx: float
    wy: float
    wxx: float
    wxy: float
    wyy: float
    ww: float  # of w^2

    def many(self) -> float:
        """As many cells of equal weight tell as much: (sum w)^2 / sum w^2."""
        return self.w * self.w / self.ww if self.ww > 0.0 else 0.0

    def plus(self, other: Sums, each: int) -> Sums:
        """Together with others, each of which stands for so many cells."""
        return Sums(*(a + each * b for a, b in zip(self, other, strict=True)))

    def moments(self) -> Moments:
        x, y = self.wx / self.w, self.wy / self.w
        xx, xy, yy = self.wxx / self.w - x * x, self.wxy / self.w - x * y, self.wyy / self.w - y * y
        return x, y, max(0.0, xx), xy, max(0.0, yy)


def best(lines: Sequence[Line]) -> tuple[float, int, int]:
    """The greatest value, its i and its j."""
    i, js, row, top = max(lines, key=itemgetter(3))
    return top, i, int(js[row.index(top)])


def sums(lines: Sequence[Line], top: float, scale: float) -> Sums:
    """Over the cells of lines.

    Args:
        top: the map's value of the best cell.
    """
    floor = top - CUT / scale
    w = wx = wy = wxx = wxy = wyy = ww = 0.0
    blank: dict[tuple[float, float], tuple[float, float, float, float]] = {}  # lines no event has touched are all the same
    for x, js, row, highest in lines:
        if highest <= floor:
            continue
        if row[0] == highest and row.count(highest) == len(row):
            kind = highest, js[0]
            if kind not in blank:
                blank[kind] = _line(js, row, top, floor, scale)
            here, y, yy, squares = blank[kind]
        else:
            here, y, yy, squares = _line(js, row, top, floor, scale)
        w += here
        wx += here * x
        wy += y
        wxx += here * x * x
        wxy += y * x
        wyy += yy
        ww += squares
    return Sums(w, wx, wy, wxx, wxy, wyy, ww)


def _line(
    js: Sequence[float], row: Sequence[float], top: float, floor: float, scale: float
) -> tuple[float, float, float, float]:
    """Sums of w, w y, w y^2 and w^2."""
    w = wy = wyy = ww = 0.0
    for y, m in zip(js, row):  # noqa: B905 - strict takes a tenth of the time of a line
        if m > floor:
            weight = exp((m - top) * scale)
            w += weight
            ww += weight * weight
            weight *= y
            wy += weight
            wyy += weight * y
    return w, wy, wyy, ww


def moments_of_parts(lines: Sequence[Line], top: float, scale: float) -> Moments:
    """Over 3 x 3 parts of cells, where L is the parabola through the middles of nine cells; at the edge as in the middle."""
    floor = top - CUT / scale
    last, end = len(lines) - 1, len(lines[0][1]) - 1
    total = wx = wy = wxx = wxy = wyy = 0.0
    for n, (i, js, row, highest) in enumerate(lines):
        if highest <= floor:
            continue
        before, after = lines[max(n - 1, 0)][2], lines[min(n + 1, last)][2]
        for k, (j, m) in enumerate(zip(js, row, strict=True)):
            if m <= floor:
                continue
            here = (m - top) * scale
            left = right = low = high = both = 0.0
            if 0 < n < last:
                left, right = _slopes(before[k], m, after[k], scale)
            if 0 < k < end:
                low, high = _slopes(row[k - 1], m, row[k + 1], scale)
                both = 0.25 * (after[k + 1] - after[k - 1] - before[k + 1] + before[k - 1]) * scale
            # exp(a + b) = exp(a) exp(b): eight exponentials a cell
            v0, v2 = exp(high / 9.0 - low / 3.0), exp(high / 9.0 + low / 3.0)
            turn = exp(both / 9.0)
            for u, less, more in ((-1.0 / 3.0, turn * v0, v2 / turn), (0.0, v0, v2), (1.0 / 3.0, v0 / turn, turn * v2)):
                w, x = exp(here + left * u + right * u * u), i + u
                w0, w1, w2 = w * (less + 1.0 + more), w * (more - less) / 3.0, w * (more + less) / 9.0
                total += w0
                wx += w0 * x
                wxx += w0 * x * x
                wy += w0 * j + w1
                wxy += (w0 * j + w1) * x
                wyy += w0 * j * j + 2.0 * w1 * j + w2
    return Sums(total, wx, wy, wxx, wxy, wyy, 0.0).moments()


def _slopes(before: float, here: float, after: float, scale: float) -> tuple[float, float]:
    """Slope and half the curvature of L at a cell, per cell."""
    return 0.5 * (after - before) * scale, 0.5 * (after - 2 * here + before) * scale
