"""Who is near whom: what a ring of range finders around a robot tells of the others.

Rules: pure, no noise; true positions, dead bodies too. A robot is told how far each hand within range is ahead and to the
left of its own, not whose it is, so that an error of its odometry or compass makes no difference. Nothing is told when
nobody is near.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin

from world_server.bodies import Unicycle

Near = tuple[tuple[float, float], ...]


def near(robots: Sequence[Unicycle], reach: float) -> list[Near]:
    """The hands within `reach`, m, of each robot's: (ahead, left), m, the nearest first."""
    found: list[list[tuple[float, float, float]]] = [[] for _ in robots]
    reach2 = reach * reach
    for i, one in enumerate(robots):
        x, y, of_one = one.hand_x, one.hand_y, found[i]
        for j in range(i):
            other = robots[j]
            dx = other.hand_x - x
            if -reach <= dx <= reach:
                dy = other.hand_y - y
                r2 = dx * dx + dy * dy
                if r2 <= reach2:
                    of_one.append((r2, dx, dy))
                    found[j].append((r2, -dx, -dy))
    return [_seen(robot.theta, each) if each else () for robot, each in zip(robots, found, strict=True)]


def _seen(theta: float, others: list[tuple[float, float, float]]) -> Near:
    c, s = cos(theta), sin(theta)
    return tuple([(c * dx + s * dy, c * dy - s * dx) for _, dx, dy in sorted(others)])
