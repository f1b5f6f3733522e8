"""Mean and spread of where the source may be, below the size of a cell where the map is sharp.

Rules: a function of the map alone. The best cell is looked for first, and every cell of the body about it counts. What is
further off is told by a sample of every coarse cell where it is wide, else by the fine cells of the box that holds what
counts. Next to nothing there does not count. Where the spread is a few cells, each cell that matters is divided into 3 x 3
parts, with the logarithm between the middles of cells by the parabola through three of them: the map is smooth on that
scale, for the way of the air has a width, and the mean is not bound to the middles of cells.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from math import sqrt
from typing import NamedTuple

from robot_agent.interfaces import Posterior
from robot_agent.plume.map import COARSE, EventMap
from robot_agent.plume.moments import CUT, Line, Moments, Sums, best, moments_of_parts, sums

BETWEEN = 30.0  # nats below the best sample: the best cell lies between samples, and may be here
MANY = 21  # samples of equal weight: as many tell a posterior,
HIDDEN = 2.0  # nats: where nothing between them is higher than the best of them by more than this
EACH = COARSE**2  # cells that a sample stands for
LARGE = 280  # cells of a box: of a larger one every second line across it, every third, ... is taken,
SMALLER = 0.7  # and it is made smaller as long as it becomes so by this,
BOTH = 4.0  # deviations to both sides of the mean
SHARP = 3.0  # cells: a smaller spread is looked at more closely
BODY = 5  # cells about the best one. Is this much or less further off,
FAR = 0.02  # it no longer counts: a faint place far away would widen a deviation that is to say whether all is certain

Crest = tuple[float, int, int]  # M, i, j


def posterior(chart: EventMap) -> Posterior:
    """Moments of exp(L), normalised."""
    x, y, xx, xy, yy = _moments(chart, chart.scale())
    c = chart.cell
    return Posterior(chart.x0 + (x + 0.5) * c, chart.y0 + (y + 0.5) * c, xx * c * c, xy * c * c, yy * c * c)


def spread(p: Posterior) -> float:
    """Root of the trace of the covariance, m."""
    return sqrt(max(0.0, p.xx + p.yy))


class Body(NamedTuple):
    """The cells about the best one."""

    i: int  # of a cell that is the best or beside it
    j: int
    xs: range
    ys: range
    lines: list[Line]
    peak: float  # M of the best cell
    inside: Sums


def _moments(chart: EventMap, scale: float) -> Moments:
    samples = chart.sample()
    top, _, _ = seen = best(samples)
    low = top - BETWEEN / scale
    may = [i for i, _, _, high in samples if high > low]
    crests = [seen, *chart.crests(_box(may[0], may[-1], chart.nx))]
    highest, i, j = max(crests)
    hidden = highest > top + HIDDEN / scale
    if not hidden and (told := sums(samples, top, scale)).many() >= MANY:
        return told.moments()
    body = _body(chart, i, j, scale)
    if hidden:
        outside = sums(_without(samples, body), body.peak, scale)
        if outside.many() >= MANY and EACH * outside.w > body.inside.w:
            return body.inside.plus(outside, EACH).moments()
    xs, ys = _counts(samples, crests, body.peak - CUT / scale)
    if _within(xs, body.xs) and _within(ys, body.ys):
        return _near(body.lines, body.inside.moments(), body.peak, scale)
    return _closely(chart, body, _box(xs[0], xs[-1], chart.nx), _box(ys[0], ys[-1], chart.ny), scale)


def _body(chart: EventMap, i: int, j: int, scale: float) -> Body:
    xs, ys = _box(i, i, chart.nx, BODY), _box(j, j, chart.ny, BODY)
    lines = _lines(chart, xs, ys)
    peak, _, _ = best(lines)
    return Body(i, j, xs, ys, lines, peak, sums(lines, peak, scale))


def _closely(chart: EventMap, body: Body, xs: range, ys: range, scale: float) -> Moments:
    """Over the body and the fine cells of a box.

    A large box is looked at in every nth line across it, which tells where the smaller one is that holds nearly all.
    """
    small = False
    while True:
        every = 1 if small else len(xs) * len(ys) // LARGE + 1
        lines = _lines(chart, *((xs[::every], ys) if len(xs) > len(ys) else (xs, ys[::every])))
        outside = sums(_without(lines, body), body.peak, scale)
        if every * outside.w < FAR * body.inside.w:
            return _near(body.lines, body.inside.moments(), body.peak, scale)
        found = x, y, xx, _, yy = body.inside.plus(outside, every).moments()
        if every == 1:
            return _near(lines, found, body.peak, scale)
        dx, dy, size = BOTH * sqrt(xx), BOTH * sqrt(yy), len(xs) * len(ys)
        xs = _box(max(min(int(x - dx), body.i), xs[0]), min(max(int(x + dx), body.i), xs[-1]), chart.nx)
        ys = _box(max(min(int(y - dy), body.j), ys[0]), min(max(int(y + dy), body.j), ys[-1]), chart.ny)
        small = len(xs) * len(ys) > SMALLER * size
        if small and (outside.many() >= MANY or every > COARSE):
            return found


def _near(lines: Sequence[Line], found: Moments, peak: float, scale: float) -> Moments:
    return moments_of_parts(lines, peak, scale) if found[2] + found[4] < SHARP**2 else found


def _counts(samples: Sequence[Line], crests: Sequence[Crest], floor: float) -> tuple[range, range]:
    """The box of what is above `floor`."""
    _, i, j = max(crests)
    us, vs = [i], [j]
    for m, u, v in crests:
        if m > floor:
            us.append(u)
            vs.append(v)
    for u, js, row, top in samples:
        if top > floor:
            us.append(u)
            high = [int(v) for v, m in zip(js, row, strict=True) if m > floor]
            vs += high[0], high[-1]
    return range(min(us), max(us) + 1), range(min(vs), max(vs) + 1)


def _within(inner: range, outer: range) -> bool:
    return inner[0] in outer and inner[-1] in outer


def _without(lines: Sequence[Line], body: Body) -> list[Line]:
    """What of lines is outside the body."""
    outside: list[Line] = []
    for line in lines:
        u, js, row, _ = line
        if u in body.xs:
            low, high = bisect_left(js, body.ys[0]), bisect_left(js, body.ys[-1] + 1)
            sides = (js[:low], row[:low]), (js[high:], row[high:])
            outside += [(u, part, cells, max(cells)) for part, cells in sides if part]
        else:
            outside.append(line)
    return outside


def _box(low: int, high: int, n: int, more: int = COARSE) -> range:
    """Cells of 0 ... n - 1 that are no more than `more` outside."""
    return range(max(0, low - more), min(n, high + more + 1))


def _lines(chart: EventMap, xs: range, ys: range) -> list[Line]:
    js = list(map(float, ys))
    return [(i, js, row, max(row)) for i, row in zip(xs, chart.window(xs, ys), strict=True)]
