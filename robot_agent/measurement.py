"""The measurement model: where the odour that I smell now may have come from, by the wind that I recorded.

Thesis section 3.3.1, (3.2)-(3.9), Algorithm 1.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from math import hypot

from protocol.scenario.sections import Arena, Decision


class WindMemory:
    """The latest wind samples, one per decision (Algorithm 1: within 100 s)."""

    __slots__ = ("_samples",)

    def __init__(self, size: int) -> None:
        self._samples: deque[tuple[float, float]] = deque(maxlen=size)

    def record(self, wind: tuple[float, float]) -> None:
        """Add the wind of now, m/s."""
        self._samples.append(wind)

    def prefill(self, winds: Iterable[tuple[float, float]]) -> None:
        """Add what was recorded before the start, oldest first."""
        self._samples.extend(winds)

    def reaches(self, x: float, y: float, dt: float, arena: Arena) -> bool:
        """Whether it goes back far enough for a measurement at (x, y): it is full, or odour released before its first
        sample would have come from outside the arena. A shorter one puts the source too near, at half of its length."""
        if len(self._samples) == self._samples.maxlen:
            return True
        sums = self.displacements(dt)
        if not sums:
            return False
        sx, sy = x - sums[-1][0], y - sums[-1][1]
        return not (arena.x_min < sx < arena.x_max and arena.y_min < sy < arena.y_max)

    def displacements(self, dt: float) -> list[tuple[float, float]]:
        """v(t_l, t_k) for every release time t_l in memory, latest first, m: sums of u(i) dt, below (3.4)."""
        x = y = 0.0
        sums = []
        for u, v in reversed(self._samples):
            x += u * dt
            y += v * dt
            sums.append((x, y))
        return sums


def measure(
    x: float,
    y: float,
    displacements: Iterable[tuple[float, float]],
    decision: Decision,
    arena: Arena,
    estimate: tuple[float, float],
) -> tuple[float, float] | None:
    """z_i(k) = x_i(k) - vbar(k) (3.9), with vbar the mean of the displacements that the gate lets through (3.6).

    Args:
        x, y: position of the detection, m.
        displacements: v(t_l, t_k), m.
        decision: `gate` says which displacements are possible. "printed": |v - x_i| < alpha per axis, which compares a
            displacement with a position and so says that the source is within alpha of the origin of coordinates;
            "area": the source x_i - v would lie in the search area; "estimate": it would lie within alpha of the
            estimate (Remark 3 read so that it makes sense).
        estimate: current estimate of the source, m; for the gate "estimate".
    Returns:
        z, m; None when no displacement passes: then nothing was measured.
    """
    alpha = decision.gate_size
    gate = decision.gate
    sum_x = sum_y = 0.0
    count = 0
    for vx, vy in displacements:
        sx, sy = x - vx, y - vy
        if gate == "area":
            passes = arena.x_min < sx < arena.x_max and arena.y_min < sy < arena.y_max
        elif gate == "printed":
            passes = abs(sx) < alpha and abs(sy) < alpha
        else:
            passes = hypot(sx - estimate[0], sy - estimate[1]) < alpha
        if passes:
            sum_x += vx
            sum_y += vy
            count += 1
    if count == 0:
        return None
    return x - sum_x / count, y - sum_y / count
