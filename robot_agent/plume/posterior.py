"""Mean and spread of where the source may be, below the size of a cell where the map is sharp.

Rules: a function of the map alone. A wide posterior is summed over a sample of every coarse cell, another one over the fine
cells of the box that holds what counts; of its body alone when next to nothing is elsewhere. Where the spread is a few
cells, each cell that matters is divided into 3 x 3 parts, with the logarithm between the middles of cells by the parabola
through three of them: the map is smooth on that scale, for the way of the air has a width, and the mean is not bound to
the middles of cells.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from math import sqrt

from robot_agent.interfaces import Posterior
from robot_agent.plume.map import COARSE, EventMap
from robot_agent.plume.moments import CUT, Line, Moments, best, moments, moments_of_parts, weight

BETWEEN = 30.0  # nats below the best sample: the best cell lies between samples, and may be here
MANY = 30  # samples of equal weight: as many tell a posterior
LARGE = 400  # cells of a box: of a larger one every second line across it, every third, ... is taken,
SMALLER = 0.7  # and it is made smaller as long as it becomes so by this,
BOTH = 4.0  # deviations to both sides of the mean
SHARP = 3.0  # cells: a smaller spread is looked at more closely
BODY = 6  # cells about the best one. Is this much or less further off,
FAR = 0.02  # it no longer counts: a faint place far away would widen a deviation that is to say whether all is certain
CELLS = 50  # of equal weight: nothing that has a body is as wide


def posterior(chart: EventMap) -> Posterior:
    """Moments of exp(L), normalised."""
    scale = chart.scale()
    samples = chart.sample()
    found, many = moments(samples, scale)
    if many < MANY:
        found = _closely(chart, samples, scale)
    x, y, xx, xy, yy = found
    c = chart.cell
    return Posterior(chart.x0 + (x + 0.5) * c, chart.y0 + (y + 0.5) * c, xx * c * c, xy * c * c, yy * c * c)


def spread(p: Posterior) -> float:
    """Root of the trace of the covariance, m."""
    return sqrt(max(0.0, p.xx + p.yy))


def _closely(chart: EventMap, samples: Sequence[Line], scale: float) -> Moments:
    """Over the fine cells of the box that holds what counts, or of its body.

    A large box is looked at in every nth line across it, which tells where the smaller one is that holds nearly all.
    """
    peak, i, j, xs, ys = _counts(chart, samples, scale)
    while (every := len(xs) * len(ys) // LARGE + 1) > 1:
        lines = _lines(chart, *((xs[::every], ys) if len(xs) > len(ys) else (xs, ys[::every])))
        found, many = moments(lines, scale)
        if many * every < CELLS and (body := _body(chart, lines, every, (peak, i, j), scale)):
            return _near(body, scale)
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
    if max(i - xs[0], xs[-1] - i, j - ys[0], ys[-1] - j) > BODY:
        lines = _body(chart, lines, 1, (peak, i, j), scale) or lines
    return _near(lines, scale)


def _near(lines: Sequence[Line], scale: float) -> Moments:
    found, _ = moments(lines, scale)
    return moments_of_parts(lines, scale) if found[2] + found[4] < SHARP**2 else found


def _body(chart: EventMap, lines: Sequence[Line], every: int, summit: tuple[int, int, int], scale: float) -> list[Line]:
    """The cells about the best one, if nearly all is there; else none.

    Args:
        lines: of all that counts; each stands for `every`.
    """
    peak, i, j = summit
    us, vs = _box(i, i, chart.nx, BODY), _box(j, j, chart.ny, BODY)
    outside: list[Line] = []
    for u, js, row in lines:
        low, high = (bisect_left(js, vs[0]), bisect_left(js, vs[-1] + 1)) if u in us else (0, 0)
        outside += [(u, part, cells) for part, cells in ((js[:low], row[:low]), (js[high:], row[high:])) if part]
    far = every * weight(outside, peak, scale)
    if far >= FAR * len(us) * len(vs):  # were every cell of the body as good as the best one
        return []
    body = _lines(chart, us, vs)
    return body if far < FAR * weight(body, peak, scale) else []


def _counts(chart: EventMap, samples: Sequence[Line], scale: float) -> tuple[int, int, int, range, range]:
    """The best cell's value, i and j, and the box that holds what counts beside it.

    How high the best cell is says what counts, and it lies between samples: so it is looked for first, where samples say
    that it may be.
    """
    cut = int(CUT / scale)
    tops = [max(row) for _, _, row in samples]
    highest = best(samples)
    may = [i for (i, _, _), top in zip(samples, tops, strict=True) if top > highest[0] - int(BETWEEN / scale)]
    crests = [highest, *chart.crests(_box(may[0], may[-1], chart.nx), highest[0] - cut)]
    _, i, j = max(crests)
    peak, i, j = best(_lines(chart, _box(i, i, chart.nx), _box(j, j, chart.ny)))
    floor = peak - cut
    us, vs = [i], [j]
    for m, u, v in crests:
        if m > floor:
            us.append(u)
            vs.append(v)
    for (u, js, row), top in zip(samples, tops, strict=True):
        if top > floor:
            us.append(u)
            vs.append(next(v for v, m in zip(js, row, strict=True) if m > floor))
            vs.append(next(v for v, m in zip(reversed(js), reversed(row), strict=True) if m > floor))
    return peak, i, j, _box(min(us), max(us), chart.nx), _box(min(vs), max(vs), chart.ny)


def _box(low: int, high: int, n: int, more: int = COARSE) -> range:
    """Cells of 0 ... n - 1 that are no more than `more` outside."""
    return range(max(0, low - more), min(n, high + more + 1))


def _lines(chart: EventMap, xs: range, ys: range) -> list[Line]:
    return [(i, ys, row) for i, row in zip(xs, chart.window(xs, ys), strict=True)]
