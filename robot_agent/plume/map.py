"""The map: for every cell of the arena the logarithm of the likelihood that the source is there, as whole numbers.

    L_k(c) = sum_e 2^((k_e - k) / T_2) dl_e(c),   T_2 = T_f log 2 / step,   dl_e: `robot_agent.plume.likelihood`

is kept as L = 2^(-k / T_2) M with M = sum_e 2^(k_e / T_2) dl_e, so that forgetting costs nothing: later events weigh more.

The way's variance grows with the lag as was measured in such winds (docs/plume-map.md), with D = D_min + k_D 5 s var(wind):
    sigma(q)^2 = sigma_0^2 + D_min q + (D - D_min) 20 q / (1 + (28 s / q)^3).
For some seconds next to nothing, for the robot met the same wind as the plume beside it; later far more than D says.

Rules: M is a sum of whole numbers, each of which depends on its event alone. Robots with the same events hold the same M to
the bit, in whatever order and however late the events came. Python's integers do not overflow.
"""

from __future__ import annotations

from math import ceil, hypot, log

from protocol.scenario.laws import PlumeMap
from protocol.scenario.sections import Arena
from robot_agent.plume.events import LAGS, Event
from robot_agent.plume.likelihood import LEVELS, ONE, REACH, SHARP, STEPS, WIDTH, Likelihood

FRACTION = 10  # bits of an event's weight
FLAT = 0.35  # least cosine between a stretch and the axis that its cells are visited along
SOFT = 0.7  # m: half of the length on which P rises from nothing where an event's way begins
SHARED = 28.0  # s: for so long the air that a robot meets now and its own samples have nearly shared the same wind
APART = 20.0  # much further back they have not, and the way's variance grows so many times faster than D says
NEAR = 3  # stretches of the way (11 s) that every miss is drawn along,
WIDE = 3.0  # m: as long as the way's deviation is below this
FAINT = 2.2  # sigmas: how far beside the way a miss is drawn; there it says less than a twentieth of what it says on it


class EventMap:
    """M, and what events do to it."""

    def __init__(self, arena: Arena, p: PlumeMap, step: float) -> None:
        """`step`: time between two decisions, s."""
        self._p = p
        self.x0, self.y0, self.cell = arena.x_min, arena.y_min, p.cell
        self.nx = max(2, ceil((arena.x_max - arena.x_min) / p.cell - 1e-9))
        self.ny = max(2, ceil((arena.y_max - arena.y_min) / p.cell - 1e-9))
        self.M = [0] * (self.nx * self.ny)  # cell (i, j) at i ny + j
        self._tables = Likelihood(p)
        self._half_life = p.forget * log(2.0) / step  # decisions
        # By which the part of D that comes of the wind's variance makes the way's variance grow up to every lag.
        self._growth = [0.0] + [APART * lag / (1.0 + (SHARED / lag) ** 3) for lag in LAGS]
        self.newest = 0

    def learn(self, k: int, event: Event) -> None:
        """Take the event of decision `k` in."""
        self.newest = max(self.newest, k)
        p = self._p
        way = event.way
        far = event.hit or (k + event.robot) % p.thin == 0
        whole, part = divmod(k / self._half_life, 1.0)
        weight = 2.0**part * (1 << FRACTION)
        end = way[-1]
        by_x = abs(end[1] - way[0][1]) >= abs(end[2] - way[0][2])
        start = self._behind(way)
        least, more = min(event.D, p.spread), max(0.0, event.D - p.spread)
        grown = [p.blur**2 + least * q + more * by for (q, _, _), by in zip(way, self._growth, strict=True)]
        near = NEAR if grown[NEAR] < WIDE**2 else NEAR - 1
        for m, two in enumerate(way[1:]):
            thick = 1 if event.hit or m < near else p.thin
            if m >= near and not far:
                return
            one = start if m == 0 else way[m]
            self._along(one, two, grown[m], grown[m + 1], event.hit, weight * thick, int(whole), by_x, m == 0)

    def scale(self) -> float:
        """What a whole number of M is worth now, nats. (The newest event known says what now is.)"""
        return float(2.0 ** -(self.newest / self._half_life)) / (ONE << FRACTION)

    def _behind(self, way: tuple[tuple[float, float, float], ...]) -> tuple[float, float, float]:
        """The way begins a little downwind of the sensor."""
        _, x, y = way[0]
        dx, dy = x - way[1][1], y - way[1][2]
        length = hypot(dx, dy)
        if length == 0.0:
            return 0.0, x, y
        r = self._p.upwind + SOFT
        return 0.0, x + r * dx / length, y + r * dy / length

    def _along(
        self,
        one: tuple[float, float, float],
        two: tuple[float, float, float],
        variance: float,
        end: float,
        hit: bool,
        weight: float,
        shift: int,
        by_x: bool,
        begins: bool,
    ) -> None:
        """Visit the cells beside a stretch of the way, line by line across its main axis."""
        M, cell, tables = self.M, self.cell, self._tables
        if by_x:
            (q1, a1, b1), (q2, a2, b2) = one, two
            a0, b0, na, nb, stride_a, stride_b = self.x0, self.y0, self.nx, self.ny, self.ny, 1
        else:
            (q1, b1, a1), (q2, b2, a2) = one, two
            a0, b0, na, nb, stride_a, stride_b = self.y0, self.x0, self.ny, self.nx, 1, self.ny
        p1, p2 = (a1 - a0) / cell - 0.5, (a2 - a0) / cell - 0.5
        first, last = (ceil(p1), ceil(p2)) if p1 < p2 else (ceil(p2), ceil(p1))
        if first < 0:
            first = 0
        if last > na:
            last = na
        run, rise, later = a2 - a1, b2 - b1, q2 - q1
        if first >= last or run == 0.0:
            return
        cosine = max(FLAT, abs(run) / hypot(run, rise))
        rows, sigmas, rungs, fine, exact, tau = (
            tables.hits if hit else tables.misses, tables.sigmas, tables.rungs, tables.fine, len(tables.rungs), tables.tau
        )  # fmt: skip
        edge = tables.begin_hits if hit else tables.begin_misses
        narrow = cosine * cell  # of a sigma across the lines, in their direction
        soft = 2.0 * SOFT * cosine
        # All that changes evenly from line to line, from line `first` on.
        part, by_part = (first - p1) / (p2 - p1), 1.0 / (p2 - p1)
        variance, by_variance = variance + part * (end - variance), by_part * (end - variance)
        middle, by_middle = (b1 + part * rise - b0) / cell - 0.5, by_part * rise / cell
        reach = (REACH if hit else FAINT) / narrow
        rung = -1
        w = round(weight) << shift
        corner = first * stride_a
        for i in range(first, last):
            n = int(variance * fine)
            n = rungs[n] if n < exact else tables.rung(variance)
            if n != rung:  # it stays for some lines
                rung, sigma, row = n, sigmas[n], rows[n]
                half, dz = reach * sigma, narrow / sigma * STEPS
            start, stop = ceil(middle - half), ceil(middle + half)
            if start < 0:
                start = 0
            if stop > nb:
                stop = nb
            if start < stop:
                if begins:
                    level = int(abs(i - p1) * cell / soft * LEVELS)
                    row = edge[level][n if n < SHARP else SHARP - 1] if level < LEVELS else rows[n]
                if not hit:
                    w = round(weight / (1.0 + (q1 + (part + (i - first) * by_part) * later) / tau)) << shift
                z = (start - middle) * dz + WIDTH
                for at in range(corner + start * stride_b, corner + stop * stride_b, stride_b):
                    M[at] += w * row[int(z)]
                    z += dz
            corner += stride_a
            variance += by_variance
            middle += by_middle
