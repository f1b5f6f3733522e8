"""Mean and spread of where the source may be, below the size of a cell where the map is sharp.

Rules: a function of the map alone. A wide posterior is summed over a sample of every coarse cell, another one over the fine
cells of the box that holds what counts. Where the spread is a few cells, each cell that matters is divided into 3 x 3
parts, with the logarithm between the middles of cells by the parabola through three of them: the map is smooth on that
scale, for the way of the air has a width, and the mean is not bound to the middles of cells.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, sqrt

from robot_agent.interfaces import Posterior
from robot_agent.plume.map import COARSE, EventMap

CUT = 9.0  # nats below the best cell: no longer counted
BETWEEN = 30.0  # nats below the best sample: the best cell lies between samples, and may be here
MANY = 30  # samples of equal weight: as many tell a posterior
LARGE = 400  # cells of a box: of a larger one every second line across it, every third, ... is taken,
SMALLER = 0.7  # and it is made smaller as long as it becomes so by this,
BOTH = 4.0  # deviations to both sides of the mean
SHARP = 3.0  # cells: a smaller spread is looked at more closely
PARTS = (-1.0 / 3.0, 0.0, 1.0 / 3.0)

Moments = tuple[float, float, float, float, float]  # mean x, y, covariance xx, xy, yy, in cells
Line = tuple[int, Sequence[int], Sequence[int]]  # i, the j of its cells, their values


def posterior(chart: EventMap) -> Posterior:
    """Moments of exp(L), normalised."""
    scale = chart.scale()
    samples = chart.sample()
    found, many = _sum(samples, scale)
    if many < MANY:
        found = _closely(chart, samples, scale)
    x, y, xx, xy, yy = found
    c = chart.cell
    return Posterior(chart.x0 + (x + 0.5) * c, chart.y0 + (y + 0.5) * c, xx * c * c, xy * c * c, yy * c * c)


def spread(p: Posterior) -> float:
    """Root of the trace of the covariance, m."""
    return sqrt(max(0.0, p.xx + p.yy))


def _closely(chart: EventMap, samples: Sequence[Line], scale: float) -> Moments:
    """Over the fine cells of the box that holds what counts.

    A large box is looked at in every nth line across it, which tells where the smaller one is that holds nearly all.
    """
    i, j, xs, ys = _counts(chart, samples, scale)
    while (every := len(xs) * len(ys) // LARGE + 1) > 1:
        thin = (xs[::every], ys) if len(xs) > len(ys) else (xs, ys[::every])
        found, _ = _sum(_lines(chart, *thin), scale)
        x, y, xx, _, yy = found
        dx, dy = BOTH * sqrt(xx), BOTH * sqrt(yy)
        us = _box(max(min(int(x - dx), i), xs[0]), min(max(int(x + dx), i), xs[-1]), chart.nx)
        vs = _box(max(min(int(y - dy), j), ys[0]), min(max(int(y + dy), j), ys[-1]), chart.ny)
        if len(us) * len(vs) > SMALLER * len(xs) * len(ys):
            if xx + yy > (2 * every) ** 2 or every > COARSE:
                return found
            break
        xs, ys = us, vs
    lines = _lines(chart, xs, ys)
    found, _ = _sum(lines, scale)
    return _fine(lines, scale) if found[2] + found[4] < SHARP**2 else found


def _counts(chart: EventMap, samples: Sequence[Line], scale: float) -> tuple[int, int, range, range]:
    """The best cell i, j, and the box that holds what counts beside it.

    How high the best cell is says what counts, and it lies between samples: so it is looked for first, where samples say
    that it may be.
    """
    cut = int(CUT / scale)
    best = _best(samples)
    may = [i for i, _, row in samples if max(row) > best[0] - int(BETWEEN / scale)]
    crests = [best, *chart.crests(_box(may[0], may[-1], chart.nx), best[0] - cut)]
    _, i, j = max(crests)
    peak, i, j = _best(_lines(chart, _box(i, i, chart.nx), _box(j, j, chart.ny)))
    floor = peak - cut
    us, vs = [i], [j]
    for m, u, v in crests:
        if m > floor:
            us.append(u)
            vs.append(v)
    for u, js, row in samples:
        if max(row) > floor:
            us.append(u)
            vs.append(next(v for v, m in zip(js, row, strict=True) if m > floor))
            vs.append(next(v for v, m in zip(reversed(js), reversed(row), strict=True) if m > floor))
    return i, j, _box(min(us), max(us), chart.nx), _box(min(vs), max(vs), chart.ny)


def _best(lines: Sequence[Line]) -> tuple[int, int, int]:
    """The greatest value, its i and its j."""
    top, i, js, row = max(((max(row), i, js, row) for i, js, row in lines), key=lambda line: line[:2])
    return top, i, js[row.index(top)]


def _box(low: int, high: int, n: int) -> range:
    """Cells of 0 ... n - 1 that are no further outside than a coarse cell."""
    return range(max(0, low - COARSE), min(n, high + COARSE + 1))


def _lines(chart: EventMap, xs: range, ys: range) -> list[Line]:
    return [(i, ys, row) for i, row in zip(xs, chart.window(xs, ys), strict=True)]


def _sum(lines: Sequence[Line], scale: float) -> tuple[Moments, float]:
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


def _fine(lines: Sequence[Line], scale: float) -> Moments:
    """In parts of cells."""
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
