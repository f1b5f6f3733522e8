"""Coloured noise: the wind's slow random swing at the corners of the arena.

Rules: a stationary second-order linear process, stepped exactly: the covariance at any two times is the process's own,
whatever the step. So the step changes no statistics, and there is no step that is too long.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from world_server.noise import StepNoise, generator_for

Array = NDArray[np.float64]


def deviation(gain: float, bandwidth: float, damping: float) -> float:
    """Stationary standard deviation of x'' + 2 zeta w x' + w^2 x = G w^2 n:  G sqrt(w / (4 zeta))."""
    return gain * math.sqrt(bandwidth / (4.0 * damping))


def transition(bandwidth: float, damping: float, dt: float) -> tuple[Array, Array]:
    """Exact step of the process in its own units (x / sigma, x' / (w sigma)), whose stationary covariance is I.

    Phi = exp(A dt) in closed form for 0 < zeta < 1, and L with L L^T = Q = I - Phi Phi^T.

    Returns:
        Phi and L, each (2, 2); L is lower triangular.
    """
    zeta, tau = damping, bandwidth * dt
    root = math.sqrt(1.0 - zeta * zeta)
    fade = math.exp(-zeta * tau)
    c, s = math.cos(root * tau), math.sin(root * tau) / root
    phi = fade * np.array([[c + zeta * s, s], [-s, c - zeta * s]])
    q = np.eye(2) - phi @ phi.T
    # For tiny steps q[0, 0] is of order tau^3 and may round to a little below 0; it is noise of no consequence then.
    l00 = math.sqrt(max(q[0, 0], 0.0))
    l10 = q[1, 0] / l00 if l00 > 0.0 else 0.0
    l11 = math.sqrt(max(q[1, 1] - l10 * l10, 0.0))
    return phi, np.array([[l00, 0.0], [l10, l11]])


class ColouredNoise:
    """`count` independent processes, started stationary; step k uses the noise at (seed, *address, k)."""

    def __init__(
        self, gain: float, bandwidth: float, damping: float, dt: float, count: int, seed: int, *address: int | str
    ) -> None:
        self._sigma = deviation(gain, bandwidth, damping)
        self._step = np.hstack(transition(bandwidth, damping, dt))  # (2, 4): [Phi L]
        self._noise = StepNoise(seed, *address)
        # Rows: x / sigma, x' / (w sigma), and the two normals of the coming step, so that a step is one product.
        self._rows = np.empty((4, count))
        self._rows[:2] = generator_for(seed, *address, "start").standard_normal((2, count))
        self._normals = self._rows[2:]

    def advance(self, k: int) -> None:
        """Make step `k`."""
        self._noise.at(k).standard_normal(out=self._normals)
        self._rows[:2] = self._step @ self._rows

    @property
    def state(self) -> Array:
        """x / sigma and x' / (w sigma) of every process, a copy of shape (2, count): all that the coming steps need."""
        return self._rows[:2].copy()

    @state.setter
    def state(self, rows: Array) -> None:
        self._rows[:2] = rows

    def values(self) -> Array:
        """x of every process, shape (count,)."""
        x: Array = self._sigma * self._rows[0]
        return x
