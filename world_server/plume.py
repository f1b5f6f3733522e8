"""The plume: filaments of odour (1.1), (1.4), (1.5), released at random, blown by the wind, spread by white noise.

Rules: nothing here depends on the step except accuracy. Spreading is sigma sqrt(dt) N(0, 1); releases are a Poisson
process with instants anywhere within a step, and a filament moves for the part of its first step that it lived; the
radius follows from the age. Positions are stepped by Euler with the wind at the end of the step: the field changes over
tens of seconds and metres, so a better scheme would only cost. Noise is addressed (seed, "plume", step).
Always released == alive + left: nothing is lost and nothing appears.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from protocol.scenario.sections import Arena, Source
from protocol.scenario.sections import Plume as PlumeTable
from world_server.growth import radius_at
from world_server.noise import StepNoise
from world_server.wind import WindField

Array = NDArray[np.float64]

FAR = 40.0  # a filament further than sqrt(FAR) radii counts as absent: it would add exp(-40) = 4e-18 of its peak
SLACK = 1e-13  # of squared lengths: a few hundred roundings


class Plume:
    """Filaments in and near the arena; `step` counts the steps made so far, time runs from its first step."""

    def __init__(self, plume: PlumeTable, source: Source, arena: Arena, seed: int) -> None:
        self.step = 0
        self.released = 0  # so far
        self.left = 0  # of those, gone further than `margin` out of the arena
        self._table = plume
        self._now = 0.0
        self._source = np.array([[source.x], [source.y]])
        self._centre = np.array([[0.5 * (arena.x_min + arena.x_max)], [0.5 * (arena.y_min + arena.y_max)]])
        self._low = (arena.x_min - plume.margin, arena.y_min - plume.margin)
        self._high = (arena.x_max + plume.margin, arena.y_max + plume.margin)
        self._extent2 = (self._high[0] - self._low[0]) ** 2 + (self._high[1] - self._low[1]) ** 2
        self._strength = plume.amount / math.sqrt(8.0 * math.pi**3)  # Q / sqrt(8 pi^3)
        self._noise = StepNoise(seed, "plume")
        self._n = 0
        self._places = np.empty((2, 1024))  # columns [:n] are alive, in no particular order
        self._births = np.empty(1024)
        self._index: tuple[Array, float] | None = None  # see _near

    @property
    def alive(self) -> int:
        """Number of filaments in and near the arena."""
        return self._n

    @property
    def positions(self) -> Array:
        """Copy of the filaments' positions, shape (2, alive), m."""
        return self._places[:, : self._n].copy()

    @property
    def radii(self) -> Array:
        """R of every filament, shape (alive,), m."""
        return self._radius(self._births[: self._n])

    @property
    def state(self) -> tuple[int, int, int, int, Array, Array]:
        """Steps, released, left, room for filaments, their places (2, alive) and births (alive,), in their order: all
        that the coming steps need; copies."""
        n = self._n
        births = self._births[:n].copy()
        return self.step, self.released, self.left, self._births.size, self._places[:, :n].copy(), births

    def restore(self, state: tuple[int, int, int, int, Array, Array], dt: float) -> None:
        """Go on from `state`; `dt`: length of the steps, s."""
        self.step, self.released, self.left, room, places, births = state
        n = self._n = births.size
        self._now = self.step * dt
        self._places, self._births = np.empty((2, room)), np.empty(room)
        self._places[:, :n], self._births[:n] = places, births
        self._index = None

    def snapshot(self) -> NDArray[np.float32]:
        """x, y, radius of every filament for telemetry, shape (alive, 3)."""
        return np.column_stack([*self._places[:, : self._n], self.radii]).astype(np.float32)

    def advance(self, wind: WindField) -> None:
        """Make one step of `wind.dt`: release, blow and spread, forget what has left."""
        dt, sigma = wind.dt, self._table.dispersion
        rng = self._noise.at(self.step)
        self.step += 1
        self._now = self.step * dt
        self._index = None
        old = self._n
        new = int(rng.poisson(self._table.release_rate * dt))
        n = old + new
        if n > self._births.size:
            self._grow(n)
        places = self._places[:, :n]
        if new:
            ages = rng.random(new)
            ages *= dt
            self._births[old:n] = self._now - ages
            places[:, old:] = self._source
            self.released += new
        if n:
            moves = wind.at_points(places)
            if sigma > 0.0:
                spread = rng.standard_normal((2, n))
                spread[:, :old] *= sigma * math.sqrt(dt)
                if new:
                    spread[:, old:] *= sigma * np.sqrt(ages)
                places += spread
            moves[:, :old] *= dt
            if new:
                moves[:, old:] *= ages
            places += moves
            self._n = n
            self._forget_leavers()

    def concentration(self, xs: ArrayLike, ys: ArrayLike) -> Array:
        """Concentration at points, (1.5):  C = sum_i Q / (sqrt(8 pi^3) R_i^3) exp(-r_i^2 / R_i^2).

        Args:
            xs, ys: shape (P,), m.
        Returns:
            C, shape (P,), ppt. Equal to the sum over all filaments but for those beyond sqrt(40) radii, which together
            add less than alive * 4e-18 of a filament's peak: 1e-11 ppt with the thesis's figures.
        """
        points = np.array([xs, ys], dtype=np.float64)
        count = points.shape[1]
        which, filament = self._near(points)
        if not which.size:
            return np.zeros(count)
        offsets = self._places.take(filament, axis=1, mode="clip")
        offsets -= points.take(which, axis=1, mode="clip")
        offsets *= offsets
        r2 = offsets[0]
        r2 += offsets[1]
        radius = self._radius(self._births[filament])
        radius2 = radius * radius
        r2 /= radius2
        np.negative(r2, out=r2)
        ppt = np.exp(r2, out=r2)
        ppt *= self._strength
        radius2 *= radius
        ppt /= radius2
        return np.bincount(which, ppt, minlength=count)  # type: ignore[return-value]  # with weights it is float64

    def _near(self, points: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Pairs (point, filament) that may be within sqrt(FAR) radii of each other; misses none.

        r^2 = |p|^2 - 2 p.x + |x|^2 is one small matrix product for all pairs. It cancels where r is small; the slack is
        above what rounding can do, so that a pair too many may come back, and the exact sum settles it.
        """
        if self._index is None:
            self._index = self._make_index()
        columns, reach2 = self._index
        local = points - self._centre
        rows = np.ones((points.shape[1], 3))
        np.multiply(local.T, -2.0, out=rows[:, :2])
        local *= local
        limit = reach2 - (1.0 - SLACK) * (local[0] + local[1])
        pairs = np.flatnonzero(rows @ columns < limit[:, None])
        which = pairs // max(self._n, 1)
        return which, pairs - which * self._n

    def _make_index(self) -> tuple[Array, float]:
        """(x, y, |x|^2) of all filaments about the arena's centre, shape (3, n); squared reach of the largest, m^2."""
        n = self._n
        columns = np.empty((3, n))
        np.subtract(self._places[:, :n], self._centre, out=columns[:2])
        np.add(columns[0] * columns[0], columns[1] * columns[1], out=columns[2])
        oldest = np.minimum.reduce(self._births[:n], initial=self._now, keepdims=True)
        largest = float(self._radius(oldest)[0])
        return columns, FAR * largest * largest + SLACK * self._extent2

    def _radius(self, births: Array) -> Array:
        table = self._table
        return radius_at(table.growth, table.radius, table.growth_rate, self._now - births)

    def _forget_leavers(self) -> None:
        """Drop the filaments beyond the margin; the last column takes the place of each."""
        n, places = self._n, self._places
        alive = places[:, :n]
        (x_low, y_low), (x_high, y_high) = self._low, self._high
        x_min, y_min = np.minimum.reduce(alive, axis=1)
        x_max, y_max = np.maximum.reduce(alive, axis=1)
        if x_min >= x_low and x_max <= x_high and y_min >= y_low and y_max <= y_high:
            return
        x, y = alive
        leavers = np.flatnonzero((x < x_low) | (x > x_high) | (y < y_low) | (y > y_high))
        for hole in leavers[::-1]:  # from the last one on, so that the last column always holds one that stays
            n -= 1
            places[:, hole] = places[:, n]
            self._births[hole] = self._births[n]
        self._n = n
        self.left += int(leavers.size)

    def _grow(self, n: int) -> None:
        """Make room for `n` filaments, and twice that."""
        places, births = np.empty((2, 2 * n)), np.empty(2 * n)
        places[:, : self._n] = self._places[:, : self._n]
        births[: self._n] = self._births[: self._n]
        self._places, self._births = places, births
