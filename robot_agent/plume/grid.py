"""Cells that the ways of the air are drawn on: sums of whole numbers, kept as doubles while these are exact.

A stretch of a way is visited line by line across its main axis. What a line adds to its cells is a row of the likelihood's
table (`robot_agent.plume.likelihood`), taken at the distances of the cells. These rows come again and again: they are kept,
by table, deviation, slant of the way and where between two cells its middle lies, each in steps.

Rules: what a stretch adds depends on it alone, not on what was drawn before; what is kept is only quicker to find. Before a
cell's sum could pass 2^53 all become Python's integers, which never overflow, but are slower.
"""

from __future__ import annotations

from math import ceil, hypot, log
from typing import NamedTuple

from robot_agent.plume.likelihood import LEVELS, REACH, STEPS, WIDTH, Likelihood

FLAT = 0.35  # least cosine between a stretch and the axis that its cells are visited along
SLANT = 1.03  # ratio of neighbouring cosines
BETWEEN = 8  # steps between two cells
SOFT = 0.7  # m: half of the length on which P rises from nothing where an event's way begins
FAINT = 2.2  # sigmas: how far beside the way a miss is drawn; there it says less than a twentieth of what it says on it
EXACT = 2**53  # as far as every whole number is a double
_COSINES = tuple(SLANT**-n for n in range(64))
_LOG_SLANT = log(SLANT)


class Stretch(NamedTuple):
    """A piece of a way: from one (lag s, x m, y m) to the other, with the variances at both."""

    one: tuple[float, float, float]
    two: tuple[float, float, float]
    variance: float  # m^2
    end: float


class Grid:
    """nx x ny cells, (i, j) at M[i ny + j]."""

    def __init__(self, x0: float, y0: float, cell: float, nx: int, ny: int, tables: Likelihood) -> None:
        self.x0, self.y0, self.cell, self.nx, self.ny = x0, y0, cell, nx, ny
        self.M: list[float] = [0.0] * (nx * ny)
        self._bound = 0  # no cell of M is larger
        self._doubles = True
        self._tables = tables
        # Tables, and how far each is drawn: misses, hits, LEVELS of misses where they begin, LEVELS of hits.
        self._kinds = [(tables.misses, FAINT), (tables.hits, REACH)]
        self._kinds += [(rows, FAINT) for rows in tables.begin_misses] + [(rows, REACH) for rows in tables.begin_hits]
        self._most = max(abs(entry) for rows, _ in self._kinds[:2] for row in rows for entry in row)
        self._kept: list[dict[int, tuple[float, ...]]] = [{} for _ in self._kinds]
        self._halves = [[reach * sigma / cell for sigma in tables.sigmas] for _, reach in self._kinds[:2]]
        self._exact = len(tables.rungs)
        self._tau = tables.tau

    def draw(self, s: Stretch, hit: bool, weight: float, shift: int, by_x: bool, begins: bool) -> None:
        """Add `weight` 2^`shift` times what the event says to the cells beside a stretch.

        Args:
            by_x: the lines are visited along x.
            begins: the way begins with this stretch.
        """
        cell = self.cell
        if by_x:
            (q1, a1, b1), (q2, a2, b2) = s.one, s.two
            a0, b0, na, nb, stride_a, stride_b = self.x0, self.y0, self.nx, self.ny, self.ny, 1
        else:
            (q1, b1, a1), (q2, b2, a2) = s.one, s.two
            a0, b0, na, nb, stride_a, stride_b = self.y0, self.x0, self.ny, self.nx, 1, self.ny
        p1, p2 = (a1 - a0) / cell - 0.5, (a2 - a0) / cell - 0.5
        first, last = (ceil(p1), ceil(p2)) if p1 < p2 else (ceil(p2), ceil(p1))
        first, last = max(first, 0), min(last, na)
        if first >= last:
            return
        run, rise = a2 - a1, b2 - b1
        slant = int(-log(max(FLAT, abs(run) / hypot(run, rise))) / _LOG_SLANT + 0.5)
        # All that changes evenly from line to line, from line `first` on.
        by = 1.0 / (p2 - p1)
        part = (first - p1) * by
        variance, by_variance = s.variance + part * (s.end - s.variance), by * (s.end - s.variance)
        middle, by_middle = (b1 + part * rise - b0) / cell - 0.5, by * rise / cell
        later, by_later = 1.0 + (q1 + part * (q2 - q1)) / self._tau, by * (q2 - q1) / self._tau
        one = self._one(round(weight), shift)
        M, kept, rungs, fine, exact = self.M, self._kept, self._tables.rungs, self._tables.fine, self._exact
        halves, wider = self._halves[hit], 1.0 / _COSINES[slant]
        steps = LEVELS * cell * wider / (2.0 * SOFT)  # a line
        kind = int(hit)
        rows = kept[kind]
        w = round(weight) * one
        corner = first * stride_a
        for i in range(first, last):
            n = int(variance * fine)
            n = rungs[n] if n < exact else self._tables.rung(variance)
            if begins:
                level = int(abs(i - p1) * steps)
                kind = 2 + LEVELS * hit + level if level < LEVELS else int(hit)
                rows = kept[kind]
            low = middle - halves[n] * wider
            start = ceil(low)
            key = (n << 6 | slant) * BETWEEN + int((start - low) * BETWEEN)
            row = rows.get(key) or self._keep(kind, key)
            if start < 0 or start + len(row) > nb:
                row, start = row[max(-start, 0) : max(nb - start, 0)], max(start, 0)
            if not hit:
                w = round(weight / later) * one
            at = corner + start * stride_b
            for entry in row:
                M[at] += w * entry
                at += stride_b
            corner += stride_a
            variance += by_variance
            middle += by_middle
            later += by_later

    def _one(self, weight: int, shift: int) -> float:
        """2^`shift`, as M's numbers are, now that entries with this weight will be added."""
        self._bound += weight * self._most << shift
        if self._bound < EXACT:
            return float(1 << shift)
        if self._doubles:
            self._doubles = False
            self.M = list(map(int, self.M))
            for rows in self._kept:
                rows.clear()
        return 1 << shift

    def _keep(self, kind: int, key: int) -> tuple[float, ...]:
        """The row of a table, at the distances of cells from the middle of a way."""
        rows, reach = self._kinds[kind]
        both, between = divmod(key, BETWEEN)
        n, slant = both >> 6, both & 63
        dz = _COSINES[slant] * self.cell / self._tables.sigmas[n]
        table = rows[min(n, len(rows) - 1)]
        z = -reach + (between + 0.5) / BETWEEN * dz
        row: list[float] = []
        while z < reach:
            row.append(table[int(z * STEPS + WIDTH)])
            z += dz
        self._kept[kind][key] = kept = tuple(map(float, row) if self._doubles else row)
        return kept
