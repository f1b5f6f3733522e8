"""Sums over lines of cells: the mean and the covariance of exp(L), normalised.

A line is i, the j of its cells, and their values of the map; where i and j are fine cells. Of the cells those count that are
no more than `CUT` below the best one.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import exp

CUT = 9.0  # nats
PARTS = (-1.0 / 3.0, 0.0, 1.0 / 3.0)

Moments = tuple[float, float, float, float, float]  # mean x, y, covariance xx, xy, yy, in cells
Line = tuple[int, Sequence[int], Sequence[int]]


def best(lines: Sequence[Line]) -> tuple[int, int, int]:
    """The greatest value, its i and its j."""
    tops = [max(row) for _, _, row in lines]
    top = max(tops)
    n = len(tops) - 1 - tops[::-1].index(top)  # of equal ones the last line
    i, js, row = lines[n]
    return top, i, js[row.index(top)]


def weight(lines: Sequence[Line], top: int, scale: float) -> float:
    """Sum of exp(L), in units of that of a cell with the value `top`."""
    floor = top - int(CUT / scale)
    return sum(exp((m - top) * scale) for _, _, row in lines if max(row) > floor for m in row if m > floor)


def moments(lines: Sequence[Line], scale: float) -> tuple[Moments, float]:
    """Moments over the cells of lines, and of how many cells of equal weight they are: (sum w)^2 / sum w^2."""
    tops = [max(row) for _, _, row in lines]
    top = max(tops)
    floor = top - int(CUT / scale)
    sums: list[tuple[float, float, float, float]] = []
    blank: dict[tuple[int, int], tuple[float, float, float, float]] = {}  # lines no event has touched are all the same
    total = squares = 0.0
    for (i, js, row), highest in zip(lines, tops, strict=True):
        if highest <= floor:
            continue
        if row[0] == highest and row.count(highest) == len(row):
            kind = highest, js[0]
            if kind not in blank:
                blank[kind] = _line(js, row, top, floor, scale)
            w, wy, wyy, ww = blank[kind]
        else:
            w, wy, wyy, ww = _line(js, row, top, floor, scale)
        sums.append((i, w, wy, wyy))
        total += w
        squares += ww
    return _moments(sums), total * total / squares


def _line(js: Sequence[int], row: Sequence[int], top: int, floor: int, scale: float) -> tuple[float, float, float, float]:
    """Sums of w, w y, w y^2 and w^2."""
    w = wy = wyy = ww = 0.0
    for y, m in zip(js, row, strict=True):
        if m > floor:
            weight = exp((m - top) * scale)
            w += weight
            ww += weight * weight
            weight *= y
            wy += weight
            wyy += weight * y
    return w, wy, wyy, ww


def moments_of_parts(lines: Sequence[Line], scale: float) -> Moments:
    """In 3 x 3 parts of cells, where L is the parabola through the middles of three cells."""
    top = max(max(row) for _, _, row in lines)
    floor = top - int(CUT / scale)
    last, end = len(lines) - 1, len(lines[0][1]) - 1
    sums: list[tuple[float, float, float, float]] = []
    for n, (i, js, row) in enumerate(lines):
        if max(row) <= floor:
            continue
        before, after = lines[max(n - 1, 0)][2], lines[min(n + 1, last)][2]
        for k, (j, m) in enumerate(zip(js, row, strict=True)):
            if m <= floor:
                continue
            here = (m - top) * scale
            left, right = _slopes(before[k], m, after[k], scale) if 0 < n < last else (0.0, 0.0)
            low, high = _slopes(row[k - 1], m, row[k + 1], scale) if 0 < k < end else (0.0, 0.0)
            # exp(a + b) = exp(a) exp(b): 3 + 3 exponentials a cell
            w0 = w1 = w2 = 0.0
            for v in PARTS:
                w, y = exp(low * v + high * v * v), j + v
                w0 += w
                w1 += w * y
                w2 += w * y * y
            for u in PARTS:
                w = exp(here + left * u + right * u * u)
                sums.append((i + u, w * w0, w * w1, w * w2))
    return _moments(sums)


def _slopes(before: int, here: int, after: int, scale: float) -> tuple[float, float]:
    """Slope and half the curvature of L at a cell, per cell."""
    return 0.5 * (after - before) * scale, 0.5 * (after - 2 * here + before) * scale


def _moments(sums: Sequence[tuple[float, float, float, float]]) -> Moments:
    """Of lines, each as its x and its sums of w, w y, w y^2."""
    total = x = y = xx = xy = yy = 0.0
    for u, w, wy, wyy in sums:
        total += w
        x += w * u
        y += wy
        xx += w * u * u
        xy += wy * u
        yy += wyy
    x, y = x / total, y / total
    return x, y, max(0.0, xx / total - x * x), xy / total - x * y, max(0.0, yy / total - y * y)
