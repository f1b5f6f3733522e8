"""The robots' bodies: unicycles (1.6) driven by wheel torques, seen at the hand (1.8), (1.9).

Rules: torques are constant over a tick, so speeds are clipped straight lines in time, and all robots and substeps of a
tick are one array: no loop. Clipping is a closed form because a line that has met its limit stays there for the tick.
Headings and positions take the speeds and the heading in the middle of each substep (second order). Nothing is random.
There are no walls: a robot may drive out of the arena, where there is no odour to find, and it is up to it to return.

Positions are complex numbers inside this module, x + i y: turning is a product.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from protocol.scenario.sections import Body, Timing

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


def _as_pairs(points: Complex) -> Array:
    """Complex numbers as (x, y) on a new last axis."""
    pairs: Array = points.view(np.float64).reshape(*points.shape, 2)
    return pairs


class Path:
    """Where the hands were during one tick."""

    __slots__ = ("h", "track", "ways")

    def __init__(self, track: Complex, ways: Array, h: float) -> None:
        self.track = track  # x + i y at the start of the tick and at the end of every substep, shape (N, S + 1), m
        self.ways = ways  # how far each hand went, shape (N,), m
        self.h = h  # length of a substep, s

    @property
    def hands(self) -> Array:
        """Hand positions at the ends of the substeps, shape (N, S, 2), m."""
        return _as_pairs(self.track[:, 1:])


class Bodies:
    """N robots; every array attribute has shape (N,)."""

    def __init__(self, body: Body, timing: Timing, x: ArrayLike, y: ArrayLike, theta: ArrayLike) -> None:
        """Robots at rest with the centre of the axle at (x, y), m, heading theta, rad."""
        self.theta = np.array(theta, dtype=np.float64)  # rad, not wrapped
        self.travelled = np.zeros_like(self.theta)  # way of the hand so far, m
        n = self.theta.size
        self._body = body
        self._speeds = np.zeros((2, n))  # nu, omega
        self._centre = np.array(x, dtype=np.float64) + 1j * np.array(y, dtype=np.float64)
        self._hand = self._centre + body.hand * np.exp(1j * self.theta)
        self._braking: NDArray[np.bool_] | None = None
        substeps = max(1, math.ceil(timing.tick / timing.substep - 1e-9))
        self._tick = timing.tick
        self._h = timing.tick / substeps
        self._sampled = np.append(self._h * (np.arange(substeps) + 0.5), timing.tick)
        self._limits = np.array([[[body.max_speed]], [[body.max_turn]]])
        self._lowest = -self._limits

    @property
    def x(self) -> Array:
        """Centre of the axle, m."""
        x: Array = self._centre.real
        return x

    @property
    def y(self) -> Array:
        """Centre of the axle, m."""
        y: Array = self._centre.imag
        return y

    @property
    def nu(self) -> Array:
        """Forward speed, m/s."""
        nu: Array = self._speeds[0]
        return nu

    @property
    def omega(self) -> Array:
        """Turn rate, rad/s."""
        omega: Array = self._speeds[1]
        return omega

    def hands(self) -> Array:
        """Hand positions (1.8):  x_i = r_i + L (cos theta, sin theta); shape (N, 2), m."""
        return _as_pairs(self._hand.copy())

    def hand_velocities(self) -> Array:
        """Hand velocities (1.9):  v_i = nu (cos theta, sin theta) + L omega (-sin theta, cos theta); (N, 2), m/s."""
        nu, omega = self._speeds
        return _as_pairs((nu + 1j * (self._body.hand * omega)) * np.exp(1j * self.theta))

    def brake(self, mask: ArrayLike) -> None:
        """From now on, until the next call, robots in `mask`, (N,) bool, ignore their torques and come to rest as fast
        as their wheels can; the others do as they are told."""
        braking = np.array(mask, dtype=bool)
        self._braking = braking if braking.any() else None

    def step(self, tau_left: ArrayLike, tau_right: ArrayLike) -> Path:
        """Move through one tick.

        Thesis (1.6) with F and tau from (1.11), (1.12) inverted; m and J cancel:
            nu' = F / m = b (tau_l + tau_r) / (2 J_wheel),    omega' = tau / J = b (tau_r - tau_l) / (l J_wheel)

        Args:
            tau_left, tau_right: wheel torques, shape (N,), N m; clipped to +-max_torque, each wheel by itself, or with
                saturation "proportional" both by the same factor.
        Returns:
            The way of the hands.
        """
        body, h = self._body, self._h
        b, axle, wheel_inertia = body.wheel_radius, body.axle, body.wheel_inertia
        tau_l, tau_r = self._applied(np.array([tau_left, tau_right], dtype=np.float64))
        rate = np.empty_like(self._speeds)
        np.add(tau_l, tau_r, out=rate[0])
        np.subtract(tau_r, tau_l, out=rate[1])
        rate[0] *= b / (2.0 * wheel_inertia)
        rate[1] *= b / (axle * wheel_inertia)
        # nu and omega in the middle of all substeps, and at the end of the tick: (2, N, S + 1)
        speeds = rate[:, :, None] * self._sampled
        speeds += self._speeds[:, :, None]
        np.maximum(speeds, self._lowest, out=speeds)
        np.minimum(speeds, self._limits, out=speeds)
        moves, turns = speeds[:, :, :-1] * h
        # e^(i theta) in the middle and at the end of all substeps: (2, N, S)
        turned = np.zeros((2, *turns.shape), dtype=np.complex128)
        middle, end = turned.imag
        np.add.accumulate(turns, axis=1, out=end)
        end += self.theta[:, None]
        turns *= 0.5
        np.subtract(end, turns, out=middle)
        self.theta = end[:, -1].copy()
        ahead, hand_ahead = np.exp(turned, out=turned)
        ahead *= moves
        track = np.empty((moves.shape[0], self._sampled.size), dtype=np.complex128)
        track[:, 0] = self._hand
        points = track[:, 1:]
        np.add.accumulate(ahead, axis=1, out=points)
        points += self._centre[:, None]
        self._centre = points[:, -1].copy()
        hand_ahead *= body.hand
        points += hand_ahead
        ways: Array = np.add.reduce(np.abs(points - track[:, :-1]), axis=1)
        self.travelled += ways
        self._hand = track[:, -1].copy()
        self._speeds = speeds[:, :, -1].copy()
        return Path(track, ways, h)

    def _applied(self, torques: Array) -> Array:
        """Torques (2, N) after brakes and saturation."""
        body = self._body
        most = body.max_torque
        if self._braking is not None:
            # A wheel's rim obeys v' = b tau / J_wheel on its own, so each wheel is stopped on its own: by the torque
            # that stops it within the tick, or the largest that there is.
            nu, omega = self._speeds
            sideways = 0.5 * body.axle * omega
            rims = np.array([nu - sideways, nu + sideways])
            stop = rims * (-body.wheel_inertia / (body.wheel_radius * self._tick))
            np.clip(stop, -most, most, out=stop)
            torques = np.where(self._braking, stop, torques)
        if body.saturation == "proportional":
            largest = np.maximum.reduce(np.abs(torques), axis=0)
            torques *= most / np.maximum(largest, most)
            return torques
        np.maximum(torques, -most, out=torques)
        np.minimum(torques, most, out=torques)
        return torques
