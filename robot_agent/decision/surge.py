"""Surge: the group drives upwind in formation, whatever it smells. A baseline: nothing is decided about the source.

Before the first detection in the group the common crosswind search is the same as for every other algorithm; from then
on odour plays no part. The middle of the group turns near the edge of the arena, goes back downwind and to one side, and
drives upwind again along another line; each further return goes to the other side and further. Each robot takes the wind
that it measures itself and the middle of those whose place it knows; who comes to the end of a leg first proposes the
next one, and the number of the leg travels over the graph as a maximum.
"""

from __future__ import annotations

from math import hypot

from protocol.scenario import RobotScenario
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import Around, Decision, Fresh, Point
from robot_agent.kalman import Estimate

AHEAD = 10.0  # the place to drive to lies this far ahead, m; only its direction counts


class NoDecision(Decision):
    """What decisions that decide nothing have in common: `h` is where this robot drives to, nothing is estimated."""

    decides = False

    def __init__(self, scenario: RobotScenario) -> None:
        self._s = scenario
        self._wind: Point = (1.0, 0.0)  # unit vector of the local wind, where it blows to
        self.state: Point = (0.0, 0.0)
        self.h: Point = (0.0, 0.0)
        self.estimate = Estimate(0.0, 0.0, scenario.decision.initial_variance)

    def begin(self, own: Own) -> None:
        self._stand(own)

    def _stand(self, own: Own) -> None:
        """Nothing is known but the own place: that is all that the shared state says."""
        self.state = self.h = (own.x, own.y)
        self.estimate = Estimate(own.x, own.y, self._s.decision.initial_variance)

    def _feel_wind(self, own: Own) -> Point:
        size = hypot(own.wind_x, own.wind_y)
        if size > 0.0:
            self._wind = (own.wind_x / size, own.wind_y / size)
        return self._wind


class SurgeDecision(NoDecision):
    """Upwind to the edge, back beside it, upwind again."""

    def __init__(self, scenario: RobotScenario) -> None:
        super().__init__(scenario)
        self._p = scenario.surge
        self._leg = 0  # even: upwind; odd: back
        self._heard = 0
        self._goal: Point = (0.0, 0.0)  # of the middle of the group on the way back, m

    def decide(self, own: Own, group: Group, detected: bool, around: Around) -> None:
        wind = self._feel_wind(own)
        middle = middle_of(own, around)
        self._stand(own)
        leg = max(self._leg, leg_heard(around.fresh), self._heard)
        if leg == self._leg and self._ended(middle, wind):
            leg += 1
        if leg != self._leg:
            self._leg = leg
            self._goal = self._return(middle, wind)
        if leg % 2:
            self.h = (own.x + self._goal[0] - middle[0], own.y + self._goal[1] - middle[1])
        else:
            self.h = (own.x - AHEAD * wind[0], own.y - AHEAD * wind[1])

    def advance(self, fresh: Fresh, dt: float) -> None:
        self._heard = max(self._heard, leg_heard(fresh))

    def notes(self, own: Own) -> tuple[float, ...]:
        return (float(self._leg),)

    def _ended(self, middle: Point, wind: Point) -> bool:
        if self._leg % 2 == 0:
            ahead = (middle[0] - wind[0], middle[1] - wind[1])
            here = outside(middle, self._s, self._p.margin)
            return here > 0.0 and outside(ahead, self._s, self._p.margin) > here
        way = (self._goal[0] - middle[0], self._goal[1] - middle[1])
        return way[0] * wind[0] + way[1] * wind[1] <= 0.0  # as far downwind as the goal

    def _return(self, middle: Point, wind: Point) -> Point:
        """Where the way back ends: downwind of `middle`, to this side and that in turn and ever further."""
        n = (self._leg + 1) // 2
        side = self._p.shift * n * (1 if n % 2 else -1)
        back = self._p.back
        goal = (middle[0] + back * wind[0] - side * wind[1], middle[1] + back * wind[1] + side * wind[0])
        return inside(goal, self._s, self._p.margin)


def leg_heard(fresh: Fresh) -> int:
    """The latest leg that a neighbour speaks of."""
    return max((int(s.notes[0]) for _, s in fresh if s.notes), default=0)


def middle_of(own: Own, around: Around) -> Point:
    """The mean place of all robots that this one knows of, itself included."""
    n = 1 + len(around.others)
    return (own.x + sum(o[0] for o in around.others)) / n, (own.y + sum(o[1] for o in around.others)) / n


def inside(point: Point, scenario: RobotScenario, margin: float) -> Point:
    """The nearest point that is `margin` or more within the arena (its middle where the arena is too small for that)."""
    arena = scenario.arena
    half_x = max(0.0, 0.5 * (arena.x_max - arena.x_min) - margin)
    half_y = max(0.0, 0.5 * (arena.y_max - arena.y_min) - margin)
    x_0, y_0 = 0.5 * (arena.x_min + arena.x_max), 0.5 * (arena.y_min + arena.y_max)
    return min(max(point[0], x_0 - half_x), x_0 + half_x), min(max(point[1], y_0 - half_y), y_0 + half_y)


def outside(point: Point, scenario: RobotScenario, margin: float) -> float:
    """How far `point` is outside of what lies `margin` within the arena, m."""
    x, y = inside(point, scenario, margin)
    return hypot(point[0] - x, point[1] - y)
