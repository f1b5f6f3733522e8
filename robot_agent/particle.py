"""The arithmetic of particle swarms, for one robot: random coefficients, oscillation centre, control signal, charge.

Rules: pure; plain floats. A draw is addressed by robot and tick, so that the decision, which makes the centre, and the
control, which pulls towards it, take the same coefficients.

Thesis (2.1) v_i(k+1) = g(v_i(k), u_i(k)), x_i(k+1) = x_i(k) + v_i(k+1); (2.2) g = omega v_i + u_i;
(2.3) u_i = alpha_1 (x_l - x_i) + alpha_2 (x_g - x_i); (2.4) p_i = (alpha_1 x_l + alpha_2 x_g) / (alpha_1 + alpha_2);
(2.5) u_i = (alpha_1 + alpha_2)(p_i - x_i).
"""

from __future__ import annotations

from collections.abc import Iterable
from math import hypot
from typing import NamedTuple, Protocol

from protocol.randomness import rng_for
from protocol.scenario.sections import Arena
from robot_agent.interfaces import Point


class Swarm(Protocol):
    """The constants of (2.1)-(2.3), with or without charge."""

    @property
    def inertia(self) -> float: ...
    @property
    def c1(self) -> float: ...
    @property
    def c2(self) -> float: ...
    @property
    def draws(self) -> str: ...


class Coefficients(NamedTuple):
    """alpha_1 and alpha_2 of (2.3), each along x and y; alpha_2 > 0."""

    alpha1: Point
    alpha2: Point

    @property
    def total(self) -> Point:
        """alpha_1 + alpha_2, along x and y."""
        return self.alpha1[0] + self.alpha2[0], self.alpha1[1] + self.alpha2[1]


class Sampling:
    """When a new k begins: at the first look, and then once every period."""

    __slots__ = ("_half", "_next", "_period")

    def __init__(self, period: float, decision: float) -> None:
        """`decision`: time between two looks, s. A period ends at the look nearest to its end."""
        self._period = period
        self._half = 0.5 * decision
        self._next = 0.0

    def due(self, t: float) -> bool:
        """Whether a new k begins at time t, s."""
        if t + self._half < self._next:
            return False
        self._next = t + self._period
        return True


def coefficients(seed: int, robot: int, tick: int, swarm: Swarm) -> Coefficients:
    """alpha_1 ~ U[0, c1), alpha_2 ~ U(0, c2] of robot `robot` at tick `tick`."""
    draws = rng_for(seed, "particle", robot, tick)
    x = (swarm.c1 * draws.uniform(), swarm.c2 * (1.0 - draws.uniform()))
    y = x if swarm.draws == "scalar" else (swarm.c1 * draws.uniform(), swarm.c2 * (1.0 - draws.uniform()))
    return Coefficients((x[0], y[0]), (x[1], y[1]))


def centre(x_l: Point, x_g: Point, alpha: Coefficients) -> Point:
    """Oscillation centre p_i of (2.4), m."""
    (ax, ay), (bx, by) = alpha
    return (ax * x_l[0] + bx * x_g[0]) / (ax + bx), (ay * x_l[1] + by * x_g[1]) / (ay + by)


def next_velocity(v: Point, x: Point, p: Point, alpha: Coefficients, inertia: float, longest: float) -> Point:
    """v_i(k+1) of (2.2) and (2.5), m per step, no longer than `longest`."""
    total_x, total_y = alpha.total
    return shortened(
        (inertia * v[0] + total_x * (p[0] - x[0]), inertia * v[1] + total_y * (p[1] - x[1])), longest
    )


def coulomb(x: Point, charged: Iterable[Point], charge: float, core: float, reach: float) -> Point:
    """Push of the other charged robots on a charged one, m per step.

    [Blackwell 2003]: a_i = sum_j Q^2 (x_i - x_j) / r^3 for core <= r <= reach; Q^2 (x_i - x_j) / (core^2 r) for r < core;
    0 for r > reach.
    """
    q2 = charge * charge
    ax = ay = 0.0
    for ox, oy in charged:
        dx, dy = x[0] - ox, x[1] - oy
        r = hypot(dx, dy)
        if 0.0 < r <= reach:
            size = q2 / max(r, core) ** 2
            ax += size * (dx / r)
            ay += size * (dy / r)
    return ax, ay


def is_charged(robot: int) -> bool:
    """Whether `robot` carries a charge: every second one, so that floor(N/2) do."""
    return robot % 2 == 1


def shortened(v: Point, longest: float) -> Point:
    """The vector v, no longer than `longest`."""
    size = hypot(*v)
    return (v[0] * longest / size, v[1] * longest / size) if size > longest else v


def within(x: Point, arena: Arena) -> Point:
    """The point of the arena that is nearest to x."""
    return min(max(x[0], arena.x_min), arena.x_max), min(max(x[1], arena.y_min), arena.y_max)
