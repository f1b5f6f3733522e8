"""How far the hand of a robot goes at most while its wheels brake, when only its speed is known.

A wheel's rim slows down at a = b tau_max / J_wheel by itself. Forward speed f = |nu| and sideways speed g = L |omega| of
the hand, V^2 = f^2 + g^2, mean rims of f +- l g / (2 L). The faster one stops after T_2, the slower one after T_1, times
which differ by what the smaller of f and l g / (2 L) takes twice. Until T_1 the hand's velocity in the body's frame is a
straight line in time, whose size is convex; then only one wheel turns, at c = sqrt(1/4 + (L/l)^2) of its rim, so that the
way is at most (T_1 V + T_2 c a (T_2 - T_1)) / 2. The worst of all f, g that the body can have is taken; a wheel that stops
within a tick takes the whole tick. Brakes act on each wheel by itself, whatever `body.saturation` says.
"""

from __future__ import annotations

from math import asin, cos, hypot, pi, sin

from protocol.scenario.sections import Body
from robot_agent.hand import fastest_hand, top_acceleration

CLASSES, ANGLES = 48, 64


class Stops:
    """Bounds on the length of the way, by classes of speed."""

    def __init__(self, body: Body, dt: float) -> None:
        self._body, self._a = body, top_acceleration(body)
        self._top = fastest_hand(body)
        self._wait = 0.5 * self._a * dt * dt
        lengths = [self._longest(self._top * (k + 1) / CLASSES) for k in range(CLASSES)]
        self._lengths = [max(lengths[: k + 1]) + self._wait for k in range(CLASSES)]
        self.longest = self._lengths[-1]  # m

    def bound(self, speed: float) -> float:
        """More than what the hand of a robot goes that brakes from `speed`, m/s."""
        # Below the first class the way is at most as the square of the speed.
        share = speed / self._top * CLASSES
        if share < 1.0:
            return (self._lengths[0] - self._wait) * share * share + self._wait
        return self._lengths[min(CLASSES - 1, int(share))]

    def _longest(self, speed: float) -> float:
        body = self._body
        turning = min(1.0, body.hand * body.max_turn / speed)
        widest = min(0.5 * pi, asin(turning))
        angles = [widest * k / ANGLES for k in range(ANGLES + 1)]
        # The factor covers what lies between two angles.
        return 1.01 * max(self._way(speed * cos(p), speed * sin(p)) for p in angles)

    def _way(self, f: float, g: float) -> float:
        body, a = self._body, self._a
        s = 0.5 * body.axle / body.hand * g
        t_1, t_2, v = abs(f - s) / a, (f + s) / a, hypot(f, g)
        c = hypot(0.5, body.hand / body.axle)
        return 0.5 * (t_1 * v + t_2 * c * a * (t_2 - t_1))
