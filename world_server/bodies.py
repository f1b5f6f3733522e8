"""The robots' bodies: unicycles (1.6) driven by wheel torques, seen at the hand (1.8), (1.9).

Rules: torques are constant over a tick, so speeds are straight lines in time, clipped at their limits. Headings and
positions take the mean speeds and the heading in the middle of each substep (second order). Nothing is random. There are
no walls: a robot may drive out of the arena, where there is no odour to find, and it is up to it to return.

Plain floats, robot by robot: with tens of robots and five substeps numpy's calls cost more than the arithmetic, above all
in a process whose caches other processes use in between.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, cos, hypot, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from protocol.motors import limited, stopping_torques
from protocol.scenario.sections import Body, Timing
from world_server.snapshot import BodyState

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


class Path:
    """Where the hands went in one tick."""

    __slots__ = ("h", "rows", "ways")

    def __init__(self, rows: list[list[complex]], ways: list[float], h: float) -> None:
        self.rows = rows  # per robot x + i y at the start and at the ends of its steps, m
        self.ways = ways  # how far each hand went, m
        self.h = h  # length of a step, s

    @property
    def track(self) -> Complex:
        """The rows as an array, shape (N, S + 1), m."""
        return np.array(self.rows, dtype=np.complex128)


class Unicycle:
    """One robot."""

    __slots__ = ("hand_x", "hand_y", "nu", "omega", "theta", "travelled", "x", "y")

    def __init__(self, x: float, y: float, theta: float, hand: float) -> None:
        self.x = x  # centre of the axle, m
        self.y = y
        self.theta = theta  # rad, not wrapped
        self.nu = 0.0  # forward speed, m/s
        self.omega = 0.0  # turn rate, rad/s
        self.travelled = 0.0  # way of the hand so far, m
        self.hand_x = x + hand * cos(theta)  # (1.8)
        self.hand_y = y + hand * sin(theta)

    def move(self, nu_dot: float, omega_dot: float, h: float, substeps: int, body: Body) -> float:
        """Move through `substeps` substeps of `h` seconds with constant accelerations; how far the hand went, m."""
        fastest, quickest = body.max_speed, body.max_turn
        x, y, theta, nu, omega = self.x, self.y, self.theta, self.nu, self.omega
        d_nu, d_omega, half = nu_dot * h, omega_dot * h, 0.5 * h
        for _ in range(substeps):
            nu_1 = nu + d_nu
            if nu_1 > fastest:
                nu_1 = fastest
            elif nu_1 < -fastest:
                nu_1 = -fastest
            omega_1 = omega + d_omega
            if omega_1 > quickest:
                omega_1 = quickest
            elif omega_1 < -quickest:
                omega_1 = -quickest
            turn = half * (omega + omega_1)
            way = half * (nu + nu_1)
            middle = theta + 0.5 * turn
            x += way * cos(middle)
            y += way * sin(middle)
            theta += turn
            nu, omega = nu_1, omega_1
        self.x, self.y, self.theta, self.nu, self.omega = x, y, theta, nu, omega
        hand_x, hand_y = x + body.hand * cos(theta), y + body.hand * sin(theta)
        went = hypot(hand_x - self.hand_x, hand_y - self.hand_y)
        self.hand_x, self.hand_y = hand_x, hand_y
        self.travelled += went
        return went


class Bodies:
    """N robots; every array attribute is a copy of shape (N,)."""

    def __init__(self, body: Body, timing: Timing, x: ArrayLike, y: ArrayLike, theta: ArrayLike) -> None:
        """Robots at rest with the centre of the axle at (x, y), m, heading theta, rad."""
        places = np.array([x, y, theta], dtype=np.float64).T.tolist()
        self.robots = [Unicycle(x_i, y_i, theta_i, body.hand) for x_i, y_i, theta_i in places]
        self._body = body
        self._braking: list[bool] = [False] * len(self.robots)
        self._substeps = max(1, ceil(timing.tick / timing.substep - 1e-9))
        self._tick = timing.tick
        self._h = timing.tick / self._substeps

    @property
    def x(self) -> Array:
        """Centre of the axle, m."""
        return np.array([r.x for r in self.robots])

    @property
    def y(self) -> Array:
        """Centre of the axle, m."""
        return np.array([r.y for r in self.robots])

    @property
    def theta(self) -> Array:
        """Heading, rad, not wrapped."""
        return np.array([r.theta for r in self.robots])

    @property
    def nu(self) -> Array:
        """Forward speed, m/s."""
        return np.array([r.nu for r in self.robots])

    @property
    def omega(self) -> Array:
        """Turn rate, rad/s."""
        return np.array([r.omega for r in self.robots])

    @property
    def travelled(self) -> Array:
        """Way of the hand so far, m."""
        return np.array([r.travelled for r in self.robots])

    @property
    def braking(self) -> tuple[bool, ...]:
        """Which robots ignore their torques now."""
        return tuple(self._braking)

    @property
    def state(self) -> tuple[BodyState, ...]:
        """All that the coming steps need."""
        return tuple(
            BodyState(r.x, r.y, r.theta, r.nu, r.omega, r.travelled, r.hand_x, r.hand_y, held)
            for r, held in zip(self.robots, self._braking, strict=True)
        )

    def restore(self, state: tuple[BodyState, ...]) -> None:
        """Go on from `state`."""
        for robot, s in zip(self.robots, state, strict=True):
            robot.x, robot.y, robot.theta, robot.nu, robot.omega = s.x, s.y, s.theta, s.nu, s.omega
            robot.travelled, robot.hand_x, robot.hand_y = s.travelled, s.hand_x, s.hand_y
        self._braking = [s.braking for s in state]

    def hands(self) -> Array:
        """Hand positions (1.8):  x_i = r_i + L (cos theta, sin theta); shape (N, 2), m."""
        return np.array([(r.hand_x, r.hand_y) for r in self.robots])

    def hand_velocities(self) -> Array:
        """Hand velocities (1.9):  v_i = nu (cos theta, sin theta) + L omega (-sin theta, cos theta); (N, 2), m/s."""
        L = self._body.hand
        rows = []
        for r in self.robots:
            c, s = cos(r.theta), sin(r.theta)
            rows.append((r.nu * c - L * r.omega * s, r.nu * s + L * r.omega * c))
        return np.array(rows)

    def brake(self, mask: ArrayLike) -> None:
        """From now on robots in `mask`, (N,) bool, ignore their torques and come to rest as fast as their wheels can;
        the others do as they are told. Until the next call."""
        self._braking = [bool(held) for held in np.asarray(mask)]

    def step(self, tau_left: Sequence[float], tau_right: Sequence[float]) -> Path:
        """Move through one tick.

        Thesis (1.6) with F and tau from (1.11), (1.12) inverted; m and J cancel:
            nu' = F / m = b (tau_l + tau_r) / (2 J_wheel),    omega' = tau / J = b (tau_r - tau_l) / (l J_wheel)

        Args:
            tau_left, tau_right: wheel torques, shape (N,), N m; clipped to +-max_torque, each wheel by itself, or with
                saturation "proportional" both by the same factor.
        Returns:
            The way of the hands, in one step from tick to tick.
        """
        body, h, substeps = self._body, self._h, self._substeps
        forward = body.wheel_radius / (2.0 * body.wheel_inertia)
        turning = body.wheel_radius / (body.axle * body.wheel_inertia)
        rows, ways = [], []
        for robot, braking, left, right in zip(self.robots, self._braking, tau_left, tau_right, strict=True):
            asked = stopping_torques(robot.nu, robot.omega, body, self._tick) if braking else (left, right)
            tau_l, tau_r = limited(*asked, body)
            start = complex(robot.hand_x, robot.hand_y)
            ways.append(robot.move(forward * (tau_l + tau_r), turning * (tau_r - tau_l), h, substeps, body))
            rows.append([start, complex(robot.hand_x, robot.hand_y)])
        return Path(rows, ways, self._tick)
