"""The potential that keeps robots apart.

Thesis (3.35) u_i = -grad U(x_i), (3.36) U = sum_i sum_{j in N(i)} U_ij(r_ij), r_ij = ||x_i - x_j||^2,
    U_ij = 1/2 (log(kappa + r) + (kappa + d^2) / (kappa + r)).
The sum runs over ordered pairs, so that each pair counts twice in the gradient:
    u_i = -sum_j 4 U'(r) (x_i - x_j),   U'(r) = 1/2 (1/(kappa + r) - (kappa + d^2)/(kappa + r)^2),
which pushes apart below d and draws together above it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot

from protocol.scenario.laws import Repulsion
from robot_agent.control.barrier import certify
from robot_agent.hand import Own
from robot_agent.interfaces import Point
from robot_agent.neighbours import Placed


def gradient_force(x: float, y: float, others: Iterable[Placed], potential: Repulsion, reach: float) -> Point:
    """-grad U at (x, y) by the robots within `reach`, m/s^2."""
    kappa, d2, reach2 = potential.kappa, potential.d**2, reach**2
    fx = fy = 0.0
    for ox, oy, _, _ in others:
        dx, dy = x - ox, y - oy
        r = dx * dx + dy * dy
        if r < reach2:
            near = kappa + r
            slope = 0.5 * (1.0 / near - (kappa + d2) / (near * near))
            fx -= 4.0 * slope * dx
            fy -= 4.0 * slope * dy
    return fx, fy


def keep_clear(u: Point, own: Own, others: Sequence[Placed], potential: Repulsion, top: float) -> Point:
    """Control signal u_i of a law that has no avoidance of its own, with (3.35) added when somebody is within d, and with
    `potential.gap` behind the barrier.

    (3.35) alone is soft: its push is largest, 7 m/s^2 for d = 2 m, at 0.4 m and falls to 0 at 0, and it knows no speed.
    The law's u_i is limited to `top`, what the wheels can give, m/s^2: laws that pull with metres per second squared for
    every metre of distance would drown any repulsion.
    """
    fx, fy = gradient_force(own.x, own.y, others, potential, potential.d)
    if fx != 0.0 or fy != 0.0:
        size = hypot(*u)
        scale = top / size if size > top else 1.0
        u = scale * u[0] + fx, scale * u[1] + fy
    return certify(u, own, others, potential, top) if potential.gap > 0.0 else u


def anyone_within(x: float, y: float, others: Iterable[Placed], reach: float) -> bool:
    """Whether a robot is nearer than `reach`."""
    reach2 = reach**2
    return any((x - ox) ** 2 + (y - oy) ** 2 < reach2 for ox, oy, _, _ in others)
