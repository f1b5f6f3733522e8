"""The map: for every cell of the arena the logarithm of the likelihood that the source is there, as whole numbers.

    L_k(c) = sum_e 2^((k_e - k) / T_2) dl_e(c),   T_2 = T_f log 2 / step,   dl_e: `robot_agent.plume.likelihood`

is kept as L = 2^(-k / T_2) M with M = sum_e 2^(k_e / T_2) dl_e, so that forgetting costs nothing: later events weigh more.

M is the sum of two grids. The part of a way that is known within `WIDE` is drawn on fine cells, the rest, which is most of
the area and has no detail, on cells that are four times as long. Between the middles of coarse cells M is linear in x and y.

Rules: M is a sum of whole numbers, each of which depends on its event alone. Robots with the same events hold the same M to
the bit, in whatever order and however late the events came. (Doubles as long as they are exact, then Python's integers.)
"""

from __future__ import annotations

from itertools import pairwise
from math import ceil, hypot, log
from operator import add, itemgetter

from protocol.scenario.laws import PlumeMap
from protocol.scenario.sections import Arena
from robot_agent.plume.events import Event
from robot_agent.plume.grid import SOFT, Grid, Stretch
from robot_agent.plume.likelihood import ONE, likelihood
from robot_agent.plume.width import variances

FRACTION = 10  # bits of an event's weight
NEAR = 3  # stretches of the way (11 s) that every second miss is drawn along (the first one: every miss),
HALF = 2
WIDE = 3.0  # m: as long as the way's deviation is below this
COARSE = 4  # fine cells along the side of a coarse one
SPOTS = (0, 2)  # fine lines of a coarse one that samples are taken on


class EventMap:
    """M, and what events do to it."""

    def __init__(self, arena: Arena, p: PlumeMap, step: float) -> None:
        """`step`: time between two decisions, s."""
        self._p = p
        self.x0, self.y0, self.cell = arena.x_min, arena.y_min, p.cell
        long = COARSE * p.cell
        nx = max(1, ceil((arena.x_max - arena.x_min) / long - 1e-9))
        ny = max(1, ceil((arena.y_max - arena.y_min) / long - 1e-9))
        self.nx, self.ny = COARSE * nx, COARSE * ny  # fine cells
        tables = likelihood(p)
        self.fine = Grid(self.x0, self.y0, p.cell, self.nx, self.ny, tables)
        self.coarse = Grid(self.x0, self.y0, long, nx, ny, tables)
        self._samples, fine, coarse = _places(nx, ny)
        # The first once more at the end, for of a single one an itemgetter makes no tuple.
        self._of_fine, self._of_coarse = itemgetter(*fine, fine[0]), itemgetter(*coarse, coarse[0])
        self._half_life = p.forget * log(2.0) / step  # decisions
        self.newest = 0

    def learn(self, k: int, event: Event) -> None:
        """Take the event of decision `k` in."""
        self.newest = max(self.newest, k)
        p = self._p
        way = event.way
        whole, part = divmod(k / self._half_life, 1.0)
        weight, shift = 2.0**part * (1 << FRACTION), int(whole)
        end = way[-1]
        by_x = abs(end[1] - way[0][1]) >= abs(end[2] - way[0][2])
        grown = variances(event, p)
        near = NEAR if grown[NEAR] < WIDE**2 else NEAR - 1
        one = self._behind(way)
        for m, two in enumerate(way[1:]):
            every = 1 if event.hit or m == 0 else HALF if m < near else p.thin
            if (k + event.robot) % every == 0:
                for grid, piece in self._split(Stretch(one, two, grown[m], grown[m + 1])):
                    grid.draw(piece, event.hit, weight * every, shift, by_x, m == 0)
            one = two

    def scale(self) -> float:
        """What a whole number of M is worth now, nats. (The newest event known says what now is.)"""
        return float(2.0 ** -(self.newest / self._half_life)) / (ONE << FRACTION)

    def _split(self, s: Stretch) -> tuple[tuple[Grid, Stretch], ...]:
        """Which piece of a stretch is drawn on which grid."""
        if s.end <= WIDE**2:
            return ((self.fine, s),)
        if s.variance >= WIDE**2:
            return ((self.coarse, s),)
        part = (WIDE**2 - s.variance) / (s.end - s.variance)
        (q1, x1, y1), (q2, x2, y2) = s.one, s.two
        here = q1 + part * (q2 - q1), x1 + part * (x2 - x1), y1 + part * (y2 - y1)
        return (self.fine, Stretch(s.one, here, s.variance, WIDE**2)), (self.coarse, Stretch(here, s.two, WIDE**2, s.end))

    def _behind(self, way: tuple[tuple[float, float, float], ...]) -> tuple[float, float, float]:
        """The way begins a little downwind of the sensor."""
        _, x, y = way[0]
        dx, dy = x - way[1][1], y - way[1][2]
        length = hypot(dx, dy)
        if length == 0.0:
            return 0.0, x, y
        r = self._p.upwind + SOFT
        return 0.0, x + r * dx / length, y + r * dy / length

    def sample(self) -> list[tuple[int, list[float], tuple[float, ...], float]]:
        """M at one fine cell of every coarse one; at other ones from line to line, so that no narrow ridge slips through.

        Returns:
            i, the js, the values and the greatest of them of each line; of the fine cells (i, j) there.
        """
        row = tuple(map(add, self._of_fine(self.fine.M), self._of_coarse(self.coarse.M)))
        return [(i, js, line := row[here], max(line)) for i, js, here in self._samples]

    def crests(self, xs: range) -> list[tuple[float, int, int]]:
        """M at the highest of the fine cells (i, j) of every second line with i in `xs`; i, j.

        One of two cells of a line is looked at: each of the others, and those between the lines, are neighbours of one. The
        fine grid says which is the highest; on the coarse one neighbours in a line differ by little.
        """
        fine, ny = self.fine.M, self.ny
        coarse, far = self.coarse.M, self.coarse.ny
        found = []
        for i in range(xs.start & ~1, xs.stop, 2):
            first = i // 2 % 2
            line = fine[i * ny + first : (i + 1) * ny : 2]
            top = max(line)
            j = first + 2 * line.index(top)
            found.append((top + coarse[i // COARSE * far + j // COARSE], i, j))
        return found

    def window(self, xs: range, ys: range) -> list[list[float]]:
        """M of the fine cells (i, j) with i in `xs` and j in `ys`, a list for every i."""
        fine, ny = self.fine.M, self.ny
        low, high = _coarse(ys[0])[0], _coarse(ys[-1])[0] + 1
        skip = ys.start - COARSE * low - COARSE // 2
        here = slice(skip, skip + ys.stop - ys.start, ys.step)
        rows = []
        lines: dict[int, list[float]] = {}
        for i in xs:
            a, s, t = _coarse(i)
            for b in (a, a + 1):
                if b not in lines:
                    lines[b] = _between(self._line(b, low, high))[here]
            cells = fine[i * ny + ys.start : i * ny + ys.stop : ys.step]
            near, far = lines[a], lines[a + 1]
            rows.append([f + s * m + t * n for f, m, n in zip(cells, near, far)])  # noqa: B905 - strict takes a tenth
        return rows

    def _line(self, a: int, low: int, high: int) -> list[float]:
        """Coarse cells (a, low) to (a, high); what lies outside is as its neighbour inside."""
        nx, ny = self.coarse.nx, self.coarse.ny
        corner = min(max(a, 0), nx - 1) * ny
        line = self.coarse.M[corner + max(low, 0) : corner + min(high, ny - 1) + 1]
        return line[:1] * -min(low, 0) + line + line[-1:] * max(high - ny + 1, 0)


def _places(nx: int, ny: int) -> tuple[list[tuple[int, list[float], slice]], list[int], list[int]]:
    """Of the samples, given the numbers of coarse cells: i, the js and which they are, by line; the cells of both grids."""
    lines: list[tuple[int, list[float], slice]] = []
    fine: list[int] = []
    coarse: list[int] = []
    for a in range(nx):
        for n in range(2):  # every other column of cells, two lines apart
            i = COARSE * a + SPOTS[n]
            js = range(COARSE * n + (a + 2 * n) % COARSE, COARSE * ny, 2 * COARSE)
            if js:
                lines.append((i, list(map(float, js)), slice(len(fine), len(fine) + len(js))))
                fine += [i * COARSE * ny + j for j in js]
                coarse += [a * ny + j // COARSE for j in js]
    return lines, fine, coarse


def _coarse(i: int) -> tuple[int, float, float]:
    """The coarse cell whose middle is the last before that of fine cell i, the weight of its value and of the next one's."""
    a, n = divmod(i - COARSE // 2, COARSE)
    t = (2 * n + 1) / (2 * COARSE)
    return a, 1.0 - t, t


def _between(line: list[float]) -> list[float]:
    """At the fine cells between the middles of coarse ones; written out, for COARSE = 4 of them, since that is quicker."""
    found: list[float] = []
    for m, n in pairwise(line):
        d = (n - m) / 8.0
        found += m + d, m + 3.0 * d, m + 5.0 * d, m + 7.0 * d
    return found
