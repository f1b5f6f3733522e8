"""Mean and spread of where the source may be, below the size of a cell where the map is sharp.

Rules: a function of the map alone. A wide posterior is summed over every fourth cell of every second row. Where the
spread is a few cells, each cell that matters is divided into 4 x 4 parts, with the logarithm between the middles of cells
by the parabola through three of them: the map is smooth on that scale, for the way of the air has a width, and the mean
is no longer bound to the middles of cells.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, sqrt

from robot_agent.interfaces import Posterior
from robot_agent.plume.map import EventMap

CUT = 9.0  # nats below the best cell: no longer counted
MANY = 60  # cells of the coarse sum: as many are a wide posterior
SHARP = 3.0  # cells: a smaller spread is looked at more closely
PARTS = (-0.375, -0.125, 0.125, 0.375)

Moments = tuple[float, float, float, float, float]  # mean x, y, covariance xx, xy, yy, in cells


def posterior(chart: EventMap) -> Posterior:
    """Moments of exp(L), normalised."""
    scale = chart.scale()
    all_over = _Window(chart, range(0, chart.nx, 2), range(0, chart.ny, 2), scale)
    found, count = all_over.moments(2)
    if count < MANY:
        (x, y, xx, _, yy), _ = all_over.moments(1)
        near = _about(x, 5.0 * sqrt(xx) + 4.0, chart.nx), _about(y, 5.0 * sqrt(yy) + 4.0, chart.ny)
        found, _ = _Window(chart, *near, scale).moments(1)
        if found[2] + found[4] < SHARP**2:
            found = _fine(chart, found, scale)
    x, y, xx, xy, yy = found
    c = chart.cell
    return Posterior(chart.x0 + (x + 0.5) * c, chart.y0 + (y + 0.5) * c, xx * c * c, xy * c * c, yy * c * c)


def spread(p: Posterior) -> float:
    """Root of the trace of the covariance, m."""
    return sqrt(max(0.0, p.xx + p.yy))


def _about(middle: float, reach: float, n: int) -> range:
    """Cells of 0 ... n - 1 within `reach` of `middle`."""
    return range(max(0, int(middle - reach)), min(n, int(middle + reach) + 2))


class _Window:
    """The cells (i, j) with i in `xs` and j in `ys`."""

    def __init__(self, chart: EventMap, xs: range, ys: range, scale: float) -> None:
        M, ny = chart.M, chart.ny
        self._xs, self._scale = xs, scale
        self._rows = [M[i * ny + ys.start : i * ny + ys.stop : ys.step] for i in xs]
        self._tops = list(map(max, self._rows))
        self._top = max(self._tops)
        self._floor = self._top - int(CUT / scale)
        self._columns = tuple(map(float, ys))

    def moments(self, step: int) -> tuple[Moments, int]:
        """Over every `step`th cell of each row, other ones from row to row; and how many of them counted."""
        top, floor, scale = self._top, self._floor, self._scale
        columns = [self._columns[turn::step] for turn in range(step)]
        sums: list[tuple[int, float, float, float]] = []
        blank: dict[tuple[int, int], tuple[float, float, float]] = {}  # rows that no event has touched are all the same
        count = turn = 0
        for i, row, highest in zip(self._xs, self._rows, self._tops, strict=True):
            turn = (turn + 1) % step
            if highest <= floor:
                continue
            if row[0] == highest and row.count(highest) == len(row):
                if (highest, turn) not in blank:
                    blank[highest, turn] = _row(row[turn::step], columns[turn], top, floor, scale)[:3]
                sums.append((i, *blank[highest, turn]))
                count += len(columns[turn])
            else:
                w, wy, wyy, n = _row(row[turn::step], columns[turn], top, floor, scale)
                sums.append((i, w, wy, wyy))
                count += n
        return _moments(sums), count


def _row(
    row: Sequence[int], columns: Sequence[float], top: int, floor: int, scale: float
) -> tuple[float, float, float, int]:
    """Sums of w, w y, w y^2 of a row, and how many cells counted."""
    w = wy = wyy = 0.0
    count = 0
    for m, y in zip(row, columns, strict=True):
        if m > floor:
            weight = exp((m - top) * scale)
            w += weight
            weight *= y
            wy += weight
            wyy += weight * y
            count += 1
    return w, wy, wyy, count


def _fine(chart: EventMap, rough: Moments, scale: float) -> Moments:
    """In parts of cells, around the rough mean."""
    M, nx, ny = chart.M, chart.nx, chart.ny
    reach = 4.0 * SHARP
    xs, ys = _about(rough[0], reach, nx), _about(rough[1], reach, ny)
    rows = [M[i * ny + ys.start : i * ny + ys.stop] for i in xs]
    tops = list(map(max, rows))
    top = max(tops)
    floor = top - int(CUT / scale)
    sums: list[tuple[float, float, float, float]] = []
    for i, row, highest in zip(xs, rows, tops, strict=True):
        if highest <= floor:
            continue
        for j, m in zip(ys, row, strict=True):
            if m <= floor:
                continue
            n = i * ny + j
            here = (m - top) * scale
            left, right = _slopes(M, n, ny if 0 < i < nx - 1 else 0, scale)
            low, high = _slopes(M, n, 1 if 0 < j < ny - 1 else 0, scale)
            # exp(a + b) = exp(a) exp(b): 4 + 4 exponentials a cell
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


def _slopes(M: Sequence[int], n: int, stride: int, scale: float) -> tuple[float, float]:
    """Slope and half the curvature of L at a cell, per cell."""
    if stride == 0:
        return 0.0, 0.0
    before, here, after = M[n - stride], M[n], M[n + stride]
    return 0.5 * (after - before) * scale, 0.5 * (after - 2 * here + before) * scale


def _moments(sums: Sequence[tuple[float, float, float, float]]) -> Moments:
    """Of rows, each as its x and its sums of w, w y, w y^2."""
    total = x = y = xx = xy = yy = 0.0
    for u, w, wy, wyy in sums:
        total += w
        x += w * u
        y += wy
        xx += w * u * u
        xy += wy * u
        yy += wyy
    if total == 0.0:  # the few that count lie between those that were looked at
        return 0.0, 0.0, 0.0, 0.0, 0.0
    x, y = x / total, y / total
    return x, y, max(0.0, xx / total - x * x), xy / total - x * y, max(0.0, yy / total - y * y)
