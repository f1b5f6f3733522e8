"""The particle of chapter 4 about its resting target: (4.8) and (4.9) in continuous time.

Rules: the force is the one the robots use (`robot_agent.sig`), the integrator is not: DOP853 with an error control,
because the settling times are read off its curves. sig(.)^a has an infinite slope at 0, so that no explicit method gets
far below the size where the linear term and sig(.)^a cease to matter to each other; the tail is therefore taken in the
robots' implicit step, which has no such limit, and its length is an argument so that it can be refined.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import inf, log

import numpy as np
from numpy.typing import NDArray

from robot_agent.sig import explicit_step, implicit_step

Array = NDArray[np.float64]
State = tuple[float, float]  # y_1 = x - p, m; y_2 = y_1', m/s

START: State = (5.0, -9.0)  # of all figures of chapter 4


@dataclass(frozen=True, slots=True)
class Gains:
    """The parameters of (4.9), (4.21). beta = 0 and gamma = 1 give (4.8), the particle swarm."""

    omega: float  # < 1, inertia
    alpha: float  # > 0
    gamma: float = 1.0  # 0 < gamma <= 1
    beta: float = 0.0  # >= 0, of the finite-time term
    a: float = 0.5  # 0 < a < 1

    def phi(self, y1: float, y2: float) -> float:
        """phi = (1 - omega) y_2 + alpha y_1, as in (4.21c)."""
        return (1.0 - self.omega) * y2 + self.alpha * y1

    @property
    def tail(self) -> float:
        """alpha / (1 - omega), 1/s: on phi = 0 the particle obeys (1 - omega) y_1' = -alpha y_1, whatever beta is."""
        return self.alpha / (1.0 - self.omega)

    @property
    def creep(self) -> float:
        """|phi| below which (4.9) creeps instead of swinging: gamma + beta |phi|^(a-1) exceeds 4 alpha/(1-omega)^2."""
        spare = 4.0 * self.alpha / (1.0 - self.omega) ** 2 - self.gamma
        return float((self.beta / spare) ** (1.0 / (1.0 - self.a))) if spare > 0.0 else inf


def force(y1: float, y2: float, g: Gains) -> float:
    """y_2' = -gamma phi - beta sig(phi)^a, (4.9b), m/s^2."""
    return -explicit_step(g.phi(y1, y2), g.gamma, g.beta, g.a, 0.0)


@dataclass(frozen=True, slots=True)
class Curve:
    """A motion: times (n,), s, and y_1, y_2 as (2, n)."""

    t: Array
    y: Array

    def size(self) -> Array:
        """max(|y_1|, |y_2|) at each time, (n,)."""
        size: Array = np.abs(self.y).max(axis=0)
        return size

    def settled(self, band: float) -> float:
        """The time after which max(|y_1|, |y_2|) stays below `band`; inf when it does not within the curve."""
        outside = np.flatnonzero(self.size() >= band)
        if len(outside) == 0:
            return float(self.t[0])
        last = int(outside[-1])
        return float(self.t[last + 1]) if last + 1 < len(self.t) else inf


def integrate(g: Gains, until: float, *, start: State = START, floor: float = 1e-4, tolerance: float = 1e-9) -> Curve:
    """(4.9) from `start`, by DOP853, sampled every 10 ms.

    Args:
        until: length of the run, s.
        floor: stop where max(|y_1|, |y_2|) falls below it, m and m/s; an explicit method creeps near 0.
        tolerance: relative error allowed in a step.
    """
    from scipy.integrate import solve_ivp

    def right(t: float, y: Array) -> list[float]:
        return [float(y[1]), force(float(y[0]), float(y[1]), g)]

    def arrived(t: float, y: Array) -> float:
        return float(np.abs(y).max()) - floor

    arrived.terminal = True  # type: ignore[attr-defined]
    run = solve_ivp(
        right,
        (0.0, until),
        start,
        method="DOP853",
        rtol=tolerance,
        atol=tolerance * floor,
        max_step=0.1,
        events=arrived,
        t_eval=np.linspace(0.0, until, round(until / 0.01) + 1),
    )
    if run.t_events[0].size:
        # The instant of arrival closes the curve.
        return Curve(np.append(run.t, run.t_events[0][0]), np.column_stack([run.y, run.y_events[0][0]]))
    return Curve(run.t, run.y)


def implicit(g: Gains, until: float, *, start: State = START, dt: float, floor: float = 0.0) -> Curve:
    """(4.9) in the step that the robots take (`control.step` = implicit), every step kept."""
    y1, y2 = start
    dt_k = dt * (1.0 - g.omega + dt * g.alpha)
    path = [(0.0, y1, y2)]
    for k in range(1, round(until / dt) + 1):
        y2 -= dt * implicit_step(g.phi(y1, y2), g.gamma, g.beta, g.a, dt_k)
        y1 += dt * y2
        path.append((k * dt, y1, y2))
        if max(abs(y1), abs(y2)) < floor:
            break
    t, a, b = np.array(path).T
    return Curve(t, np.array([a, b]))


def tail(g: Gains, until: float, *, dt: float, floor: float) -> Curve:
    """The whole way down to `floor`: `integrate` as long as the particle swings, then the implicit step."""
    begin = max(1e-4, g.creep / (g.alpha + 1.0 - g.omega))
    if begin >= max(map(abs, START)):
        return implicit(g, until, dt=dt, floor=floor)
    first = integrate(g, until, floor=begin)
    y1, y2 = (float(value) for value in first.y[:, -1])
    rest = implicit(g, until, start=(y1, y2), dt=dt, floor=floor)
    return Curve(np.append(first.t, first.t[-1] + rest.t[1:]), np.column_stack([first.y, rest.y[:, 1:]]))


def rate(curve: Curve, high: float, low: float) -> float:
    """The mean slope of -ln|y_1| between the sizes `high` and `low`, 1/s: constant when the decay is exponential."""
    size = np.abs(curve.y[0])
    i = int(np.flatnonzero(size >= high)[-1])
    j = int(np.flatnonzero(size >= low)[-1])
    return float(log(size[i] / size[j]) / (curve.t[j] - curve.t[i]))


def rates(curve: Curve, sizes: list[float]) -> list[float]:
    """`rate` from each size to the next."""
    return [rate(curve, high, low) for high, low in pairwise(sizes)]
