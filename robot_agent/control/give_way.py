"""Keeping clear in a crowd: for laws that send many robots to one place, or across each other's ways.

(3.35) alone is soft: its push is largest, 7 m/s^2 for d = 2 m, at 0.4 m and falls to 0 at 0, so that a queue of
robots that all press the same way closes the gap of the first pair. Here the law gives way instead: it fades out as the
nearest robot comes closer, and speed towards a robot is braked. Not in the thesis; as long as nobody is within d nothing
is changed.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from protocol.scenario.laws import Repulsion
from robot_agent.control.repulsion import gradient_force
from robot_agent.hand import Own
from robot_agent.interfaces import Point
from robot_agent.neighbours import Placed

APART = 1.2  # m: with somebody this near the law has no say
BRAKE = 6.0  # 1/s: closing speed dies out so fast


def give_way(u: Point, own: Own, others: Sequence[Placed], potential: Repulsion, top: float) -> Point:
    """Control signal u_i of a law, faded, with (3.35) and a brake added, when somebody is within d of `potential`.

    Args:
        u: u_i of the law, m/s^2.
        top: what the wheels can give, m/s^2; the law is limited to it.
    """
    d = nearest = potential.d
    brake_x = brake_y = 0.0
    for x, y, vx, vy in others:
        dx, dy = own.x - x, own.y - y
        distance = hypot(dx, dy)
        if distance < d:
            nearest = min(nearest, distance)
            closing = -((own.vx - vx) * dx + (own.vy - vy) * dy) / max(distance, 1e-9)
            if closing > 0.0:
                scale = BRAKE * closing / max(distance, 1e-9)
                brake_x += scale * dx
                brake_y += scale * dy
    if nearest >= d:
        return u
    push_x, push_y = gradient_force(own.x, own.y, others, potential, d)
    size = hypot(*u)
    share = max(0.0, nearest - APART) / max(d - APART, 1e-9) * (top / size if size > top else 1.0)
    return share * u[0] + push_x + brake_x, share * u[1] + push_y + brake_y
