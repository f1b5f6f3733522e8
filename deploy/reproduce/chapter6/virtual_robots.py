"""Virtual robots and double integrators (1.7) that follow them, as Examples 1 to 4 of chapter 6 have them: no bodies.

Rules: the potential, the coordination and the tracking are those of the robots (`robot_agent.control`); all robots hear
all, at once. The coordination is stepped as printed (explicit), the tracking implicitly.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from protocol.randomness import rng_for
from robot_agent.control.coordination import Gains, Virtual, accelerate, descend
from robot_agent.control.potential import Potential
from robot_agent.control.tracking import pull
from robot_agent.sig import explicit_step

Array = NDArray[np.float64]
Vector = tuple[float, float]

REST: tuple[Vector, Vector] = ((0.0, 0.0), (0.0, 0.0))


class Follow(NamedTuple):
    """Gains of (6.2)."""

    k: float = 7.0
    k1: float = 0.5
    q: float = 0.6


@dataclass(frozen=True, slots=True)
class Course:
    """Where the virtual and the real robots went."""

    t: Array  # (K,), s
    x_hat: Array  # (K, N, 2), m
    v_hat: Array  # (K, N, 2), m/s
    x: Array  # (K, N, 2), m; the virtual ones again where no real ones follow
    v: Array  # (K, N, 2), m/s


def example_potential(d: float) -> Potential:
    """The potential of the examples: r = 1.2 d, a = b = 5, eps = 0.1, h = 0.2."""
    return Potential(d, 1.2 * d, 5.0, 5.0, 0.1, 0.2)


def example_start(draw: int, robots: int = 6) -> list[Virtual]:
    """An initial state: the thesis gives none. Places within 7 m, velocities within 3 m/s of 0 along each axis."""
    rng = rng_for(draw, "reproduce", "chapter-6")
    return [Virtual(*(size * (2.0 * rng.uniform() - 1.0) for size in (7.0, 7.0, 3.0, 3.0))) for _ in range(robots)]


def simulate(
    start: Sequence[Virtual],
    potential: Potential,
    gains: Gains,
    until: float,
    *,
    dt: float = 2e-3,
    every: int = 5,
    reference: Callable[[float], tuple[Vector, Vector]] = lambda t: REST,
    leader: Callable[[float], Vector] | None = None,
    cut: bool = True,
    follow: Follow | None = None,
) -> Course:
    """The course from `start`, real robots with their virtual ones.

    Args:
        until: s. dt: step, s. every: every so many steps are kept.
        reference: w and w' at time t, m/s and m/s^2: v_c, or h_r'.
        leader: place of the virtual robot of (6.5) at time t, m; None: there is none.
        cut: whether the leader is felt within the range of the potential only.
        follow: gains of (6.2); None: no real robots.
    """
    hats = list(start)
    reals = list(start)
    kept = []
    steps = round(until / dt)
    for k in range(steps + 1):
        if k % every == 0:
            kept.append((hats, reals if follow else hats))
        now = k * dt
        w, w_dot = reference(now)
        moved = []
        for i, me in enumerate(hats):
            others = [hat for j, hat in enumerate(hats) if j != i]
            a_x, a_y = accelerate(me, [(1.0, hat) for hat in others], w, w_dot, gains, explicit_step, dt)
            slopes = [potential.slope(me.x, me.y, hat.x, hat.y) for hat in others]
            if leader is not None:
                slopes.append(potential.slope(me.x, me.y, *leader(now), cut=cut))
            slope = (sum(s for s, _ in slopes), sum(s for _, s in slopes))
            down_x, down_y = descend(slope, gains, explicit_step, dt)
            moved.append(
                Virtual(me.x + dt * (me.vx + down_x), me.y + dt * (me.vy + down_y), me.vx + dt * a_x, me.vy + dt * a_y)
            )
            if follow is not None:
                reals[i] = _follow(reals[i], me, (a_x, a_y), follow, dt)
        hats = moved
        reals = list(reals)
    table: Array = np.array(kept, dtype=np.float64)
    t: Array = np.arange(len(kept), dtype=np.float64) * (every * dt)
    return Course(t, table[:, 0, :, :2], table[:, 0, :, 2:], table[:, 1, :, :2], table[:, 1, :, 2:])


def _follow(real: Virtual, hat: Virtual, acceleration: Vector, p: Follow, dt: float) -> Virtual:
    """One step of (6.2) by a double integrator."""
    vx = real.vx + dt * (acceleration[0] - pull(real.x - hat.x, real.vx - hat.vx, p.k, p.k1, p.q, dt))
    vy = real.vy + dt * (acceleration[1] - pull(real.y - hat.y, real.vy - hat.vy, p.k, p.k1, p.q, dt))
    return Virtual(real.x + dt * vx, real.y + dt * vy, vx, vy)


def distances(places: Array) -> Array:
    """||x_i - x_j|| of all pairs, (K, N, N), m."""
    apart: Array = np.linalg.norm(places[:, :, None, :] - places[:, None, :, :], axis=-1)
    return apart


def settled(t: Array, error: Array, band: float) -> float:
    """The time after which `error` stays below `band`, s; inf when it does not."""
    outside = np.flatnonzero(error >= band)
    if len(outside) == 0:
        return float(t[0])
    last = int(outside[-1])
    return float(t[last + 1]) if last + 1 < len(t) else float("inf")
