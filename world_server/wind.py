"""The wind field (1.2), (1.3): a mean wind, coloured noise at the corners, advection and diffusion in between.

Rules: explicit steps with a discrete maximum principle. Every new value is a weighted mean of old ones with weights
that are never negative, so no component ever leaves the range that the boundary has held: the field stays finite for
every seed and gain. The step is divided where one step could not promise that. Noise is addressed (seed, "wind", step).

Layout: nodes x nodes points over the arena with one ring of ghost points around them; arrays are (2, m, m), component
first, kept flat as (2, m*m), so that a neighbour is a shifted slice.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from protocol.errors import ScenarioError
from protocol.scenario.sections import Arena, Wind
from world_server.coloured_noise import ColouredNoise

Array = NDArray[np.float64]

MAX_SUBSTEPS = 1000  # more than that and a run would seem to hang


class WindField:
    """Wind over the arena; `step` counts the steps of `dt` seconds made so far."""

    def __init__(self, wind: Wind, arena: Arena, seed: int) -> None:
        self.dt = wind.dt
        self.step = 0
        self._wind = wind
        self._m = m = wind.nodes + 2
        self._dx = (arena.x_max - arena.x_min) / (wind.nodes - 1)
        self._dy = (arena.y_max - arena.y_min) / (wind.nodes - 1)
        self._origin = np.array([[arena.x_min - self._dx], [arena.y_min - self._dy]])  # the ghost corner
        self._per_metre = np.array([[1.0 / self._dx], [1.0 / self._dy]])
        mean = wind.speed * np.array([[math.cos(wind.direction)], [math.sin(wind.direction)]])
        self._mean = mean
        # Per cell the four coefficients of the bilinear form, (4, 2, m*m); the first of them is the field itself.
        self._slopes = np.zeros((4, 2, m * m))
        self._slopes_at = -1
        self._flow = self._slopes[0]  # (2, m*m)
        self._flow[:] = mean
        self._corners = ColouredNoise(wind.gain, wind.bandwidth, wind.damping, wind.dt, 8, seed, "wind")
        self._ring, self._ring_weights = _ring(m)
        self._weights: dict[int, tuple[Array, ...]] = {}
        self._hold_ring()

    def advance(self) -> None:
        """Make one step of `dt`.

        Raises: ScenarioError when the field is not finite, or would need more than MAX_SUBSTEPS substeps.
        """
        self._corners.advance(self.step)
        self._hold_ring()
        self.step += 1
        peak = float(max(np.maximum.reduce(self._flow, axis=None), -np.minimum.reduce(self._flow, axis=None)))
        substeps = self._substeps(peak)
        for _ in range(substeps):
            self._substep(substeps, peak)

    def at(self, xs: ArrayLike, ys: ArrayLike) -> tuple[Array, Array]:
        """Wind at points, bilinear between the nodes; beyond the ghost ring it is the ring's.

        Args:
            xs, ys: shape (P,), m.
        Returns:
            u, v, each of shape (P,), m/s.
        """
        u, v = self.at_points(np.array([xs, ys], dtype=np.float64))
        return u, v

    def at_points(self, points: Array) -> Array:
        """As `at`, for points of shape (2, P) all at once; returns shape (2, P). This is what moves the filaments."""
        m = self._m
        grid = points - self._origin
        grid *= self._per_metre
        np.maximum(grid, 0.0, out=grid)
        np.minimum(grid, m - 1.0, out=grid)
        cell = np.floor(grid)
        grid -= cell  # now the fraction within the cell
        a, b = grid
        i, j = cell
        i *= m
        i += j
        # On the last row and column the fraction is 0, and what the slopes hold there does not matter.
        flow, flow_x, flow_y, flow_xy = self._cell_slopes().take(i.astype(np.intp), axis=2, mode="clip")
        flow_xy *= a
        flow_y += flow_xy
        flow_y *= b
        flow_x *= a
        flow += flow_x
        flow += flow_y
        return flow  # type: ignore[no-any-return]

    @property
    def state(self) -> tuple[int, Array, Array]:
        """Steps made so far, the field (2, m*m), the corners' noise (2, 8): all that the coming steps need; copies."""
        return self.step, self._flow.copy(), self._corners.state

    @state.setter
    def state(self, state: tuple[int, Array, Array]) -> None:
        self.step, flow, self._corners.state = state
        self._flow[:] = flow
        self._slopes_at = -1

    def nodes_in_arena(self) -> NDArray[np.float32]:
        """Wind at the interior nodes for telemetry, shape (nodes, nodes, 2): x index, y index, component."""
        inner = self._flow.reshape(2, self._m, self._m)[:, 1:-1, 1:-1]
        return np.ascontiguousarray(inner.transpose(1, 2, 0), dtype=np.float32)

    def _cell_slopes(self) -> Array:
        """The coefficients (1, a, b, ab) of the bilinear form, made once per step; shape (4, 2, m*m)."""
        if self._slopes_at != self.step:
            m = self._m
            # Both components in one row: at the ends of rows the differences are of no cell, and nobody looks there.
            flow, along_x, along_y, along_xy = self._slopes.reshape(4, -1)
            np.subtract(flow[m:], flow[:-m], out=along_x[:-m])
            np.subtract(flow[1:], flow[:-1], out=along_y[:-1])
            np.subtract(along_y[m:], along_y[:-m], out=along_xy[:-m])
            self._slopes_at = self.step
        return self._slopes

    def _hold_ring(self) -> None:
        """Set the ghost ring to mean + corner noise, linear along each edge."""
        corners = self._corners.values().reshape(2, 4)
        corners += self._mean
        self._flow[:, self._ring] = corners @ self._ring_weights

    def _substeps(self, peak: float) -> int:
        """How many substeps keep every weight from being negative while no component exceeds `peak`."""
        half_k = 0.5 * self._wind.diffusivity
        if not math.isfinite(peak):
            where = np.argwhere(~np.isfinite(self._flow.reshape(2, self._m, self._m)))
            raise ScenarioError(
                f"the wind field is not finite at step {self.step}: {len(where)} values, the first at "
                f"(component, i, j) = {tuple(where[0].tolist())}; lower wind.gain (now {self._wind.gain}) or "
                f"wind.dt (now {self._wind.dt} s)"
            )
        rate = 2.0 * sum(max(half_k, 0.5 * peak * d) / (d * d) for d in (self._dx, self._dy))
        substeps = max(1, math.ceil(self.dt * rate - 1e-9))
        if substeps > MAX_SUBSTEPS:
            raise ScenarioError(
                f"one wind step of {self.dt} s needs {substeps} substeps on a grid of {self._dx:.3g} m by "
                f"{self._dy:.3g} m, at most {MAX_SUBSTEPS} are allowed: lower wind.nodes (now {self._wind.nodes}), "
                f"wind.diffusivity (now {self._wind.diffusivity} m^2/s), wind.gain (now {self._wind.gain}) or wind.dt"
            )
        return substeps

    def _substep(self, substeps: int, peak: float) -> None:
        """One explicit step of dt / substeps of (1.2), (1.3), centred differences.

        The diffusivity is max(K / 2, |component| d / 2) along each axis of mesh d. Where |component| <= K / d, as in
        every scenario of the thesis, that is K / 2 and the scheme the plain one; beyond, the plain scheme overshoots
        and blows up, and this one becomes the upwind scheme.
        """
        m, flow = self._m, self._flow
        if substeps not in self._weights:
            self._weights[substeps] = self._plain_weights(self.dt / substeps)
        kx, ky, k, per_u, per_v = self._weights[substeps]
        here = flow[:, m + 1 : -m - 1]
        courant_x = here[0] * per_u
        courant_y = here[1] * per_v
        if peak * max(self._dx, self._dy) > self._wind.diffusivity:
            kx = np.maximum(kx, np.abs(courant_x))
            ky = np.maximum(ky, np.abs(courant_y))
            k = 2.0 * (kx + ky)
        change = flow[:, 2 * m + 1 : -1] * (kx - courant_x)
        change += flow[:, 1 : -2 * m - 1] * (kx + courant_x)
        change += flow[:, m + 2 : -m] * (ky - courant_y)
        change += flow[:, m : -m - 2] * (ky + courant_y)
        change -= here * k
        here += change

    def _plain_weights(self, h: float) -> tuple[Array, ...]:
        """Diffusion per axis and in all, Courant number per m/s per axis; 0 on the ring, which therefore stays."""
        m, half_k = self._m, 0.5 * self._wind.diffusivity
        inside = np.zeros((m, m))
        inside[1:-1, 1:-1] = 1.0
        on = inside.ravel()[m + 1 : -m - 1]
        kx, ky = h * half_k / self._dx**2, h * half_k / self._dy**2
        return kx * on, ky * on, 2.0 * (kx + ky) * on, (0.5 * h / self._dx) * on, (0.5 * h / self._dy) * on


def _ring(m: int) -> tuple[NDArray[np.intp], Array]:
    """Flat indices of the ghost ring, and the weights (4, ring) of the corners on it.

    Order of the corners: (x low, y low), (x high, y low), (x low, y high), (x high, y high).
    """
    ramp = np.arange(m) / (m - 1.0)
    a, b = np.meshgrid(ramp, ramp, indexing="ij")
    weights = np.stack([(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b])
    on_ring = np.ones((m, m), dtype=bool)
    on_ring[1:-1, 1:-1] = False
    return np.flatnonzero(on_ring), weights[:, on_ring]
