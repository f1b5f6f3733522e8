"""The others as one's own range finders show them: where they are, how they move, and how fast at most.

Rules: pure; works in the robot's own frame (ahead and left of its hand), moved on from reading to reading by its wheels,
so that neither odometry nor compass comes in. The reading before tells the velocity: the hand at p now was the nearest of
those that can have come here within the tick. Its speed now is at most the mean speed over the tick and what the wheels
can add in half a tick. One that was not there before, or after readings that were missed, is taken at its worst: it comes
straight at us, at top speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, sin
from typing import NamedTuple

from protocol.messages import Reading
from protocol.scenario import RobotScenario
from robot_agent.hand import Own, fastest_hand, strongest_push, top_acceleration
from robot_agent.interfaces import Point
from robot_agent.neighbours import Placed

ROUGH = 0.01  # m/s: error of a speed from two readings, for a forward speed that meets its limit within a tick
STILL = 0.005  # m/s: whose mean speed over a tick was less, stands as far as one can tell
SAME = 0.1  # m: a place that was told and one that is sensed, so near to each other, are one robot's
BLUR = 0.3  # m: so far inside the range, who is not sensed is not there


class Sensed(NamedTuple):
    """A hand near the own one."""

    ahead: float  # m
    left: float
    v_ahead: float  # velocity over the ground, along the same axes, m/s
    v_left: float
    fastest: float  # bound on its speed now, m/s
    stands: bool


class Proximity:
    """One robot's range finders."""

    def __init__(self, scenario: RobotScenario) -> None:
        self.range = scenario.proximity
        self._hand = scenario.body.hand
        self._dt = scenario.timing.tick
        self._top = fastest_hand(scenario.body)
        self._more = 0.5 * strongest_push(scenario.body) * self._dt + ROUGH
        self._limit = scenario.body.max_turn - 1e-9
        # A turn rate that meets its limit within a tick is no straight line in time: by so much its mean is off, rad/s.
        self._astray = 2.0 * top_acceleration(scenario.body) / scenario.body.axle * self._dt / 8.0
        self._before: tuple[int, float, float, Sequence[Point]] = (-2, 0.0, 0.0, ())
        self.bodies: list[Sensed] = []  # of this tick, the nearest first

    def sense(self, reading: Reading) -> None:
        """Take the reading of a tick."""
        tick, nu, omega, points = self._before
        self._before = (reading.tick, reading.nu, reading.omega, reading.near)
        if not reading.near:
            self.bodies = []
            return
        were = self._moved_on(points, nu, omega, reading) if reading.tick == tick + 1 else []
        astray = self._astray if abs(omega) < self._limit <= abs(reading.omega) else 0.0
        self.bodies = [self._body(p, were, astray) for p in reading.near]

    def _moved_on(self, points: Sequence[Point], nu: float, omega: float, reading: Reading) -> list[Point]:
        """Where `points` of the tick before are in the frame of now."""
        L, dt = self._hand, self._dt
        turn, way = 0.5 * dt * (omega + reading.omega), 0.5 * dt * (nu + reading.nu)
        c, s = cos(turn), sin(turn)
        hand_x, hand_y = way * cos(0.5 * turn) + L * c - L, way * sin(0.5 * turn) + L * s
        return [(c * (x - hand_x) + s * (y - hand_y), c * (y - hand_y) - s * (x - hand_x)) for x, y in points]

    def _body(self, p: Point, were: Sequence[Point], astray: float) -> Sensed:
        x, y = p
        more = astray * hypot(x, y)
        longest = (self._top + ROUGH + more) * self._dt
        ways = [way for q in were if (way := hypot(x - q[0], y - q[1])) <= longest]
        if not ways:
            r = max(hypot(x, y), 1e-9)
            return Sensed(x, y, -self._top * x / r, -self._top * y / r, self._top, False)
        near_x, near_y = min(were, key=lambda q: hypot(x - q[0], y - q[1]))
        mean = max(ways) / self._dt  # of two that it can have been, the faster
        vx, vy = (x - near_x) / self._dt, (y - near_y) / self._dt
        return Sensed(x, y, vx, vy, min(mean + self._more + more, self._top), mean <= STILL)

    def see(self, own: Own, told: Sequence[Placed]) -> list[Placed]:
        """Everybody to keep clear of: who is sensed, and who was `told` of and is out of range.

        Within range the eyes count: who is not sensed there is not there. A robot that tells exactly where it is seen is
        believed how it moves, too.
        """
        c, s, inside = cos(own.theta), sin(own.theta), self.range - BLUR
        placed = []
        for body in self.bodies:
            x, y = own.x + c * body.ahead - s * body.left, own.y + s * body.ahead + c * body.left
            same = min(((hypot(x - o[0], y - o[1]), o) for o in told), default=None)
            if same is not None and same[0] <= SAME:
                vx, vy = same[1][2], same[1][3]
            else:
                vx, vy = c * body.v_ahead - s * body.v_left, s * body.v_ahead + c * body.v_left
            placed.append((x, y, vx, vy))
        return placed + [o for o in told if hypot(o[0] - own.x, o[1] - own.y) > inside and not _in(o, placed)]


def _in(told: Placed, placed: Sequence[Placed]) -> bool:
    return any(hypot(told[0] - p[0], told[1] - p[1]) <= SAME for p in placed)
