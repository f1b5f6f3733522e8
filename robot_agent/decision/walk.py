"""A random walk: straight legs of random direction and length, each robot for itself. A baseline that senses nothing.

It begins where every other algorithm begins, after the common crosswind search, at the first detection in the group: what
it finds more slowly than they do is what they gain by deciding.
"""

from __future__ import annotations

from math import cos, hypot, pi, sin

from protocol.randomness import rng_for
from protocol.scenario import RobotScenario
from robot_agent.decision.surge import NoDecision, inside, outside
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import Around, Point

TRIES = 20  # directions drawn for a leg until one stays in the arena


class WalkDecision(NoDecision):
    """Draws leg after leg."""

    def __init__(self, scenario: RobotScenario) -> None:
        super().__init__(scenario)
        self._p = scenario.walk
        self._leg = -1
        self._goal: Point = (0.0, 0.0)
        self._until = 0.0

    def decide(self, own: Own, group: Group, detected: bool, around: Around) -> None:
        self._stand(own)
        near = hypot(self._goal[0] - own.x, self._goal[1] - own.y) < self._p.speed
        if self._leg < 0 or near or own.t >= self._until:
            self._leg += 1
            self._goal, lasts = self._draw(own)
            self._until = own.t + lasts
        self.h = self._goal

    def _draw(self, own: Own) -> tuple[Point, float]:
        """Where the next leg ends, and how long it lasts, s."""
        p = self._p
        draws = rng_for(self._s.seed, "walk", self._s.robot, self._leg)
        goal: Point = (own.x, own.y)
        lasts = min(p.shortest, p.longest)
        for _ in range(TRIES):
            angle = 2.0 * pi * draws.uniform()
            lasts = p.shortest + (p.longest - p.shortest) * draws.uniform()
            length = p.speed * lasts
            goal = (own.x + length * cos(angle), own.y + length * sin(angle))
            if outside(goal, self._s, p.margin) == 0.0:
                break
        return inside(goal, self._s, p.margin), lasts
