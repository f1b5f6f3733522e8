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
from robot_agent.hand import Own, within_reach
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


def braking(own: Own, others: Iterable[Placed], potential: Repulsion, top: float) -> Point:
    """Deceleration along the line to a robot that comes too fast, m/s^2.

    Closing at speed c with a distance r left, both have to brake with c^2 / (4 (r - gap)) to stop `potential.gap` apart.
    (3.35) knows no speed and pushes too late against 0.8 m/s each; what is below half of `top` can still wait.
    """
    fx = fy = 0.0
    for ox, oy, ovx, ovy in others:
        dx, dy = own.x - ox, own.y - oy
        closing = (ovx - own.vx) * dx + (ovy - own.vy) * dy  # times the distance
        if closing <= 0.0:
            continue
        r = hypot(dx, dy)
        need = (closing / r) ** 2 / (4.0 * max(r - potential.gap, 0.1 * potential.gap))
        if need > 0.5 * top:
            fx += need * dx / r
            fy += need * dy / r
    return fx, fy


def keep_clear(u: Point, own: Own, others: Sequence[Placed], potential: Repulsion, top: float) -> Point:
    """Control signal u_i of a law that has no avoidance of its own, with (3.35) added when somebody is within d, and
    braking before somebody who comes fast.

    The law's u_i is first limited to `top`, what the wheels can give, m/s^2: laws that pull with metres per second
    squared for every metre of distance would drown any repulsion; and from 2 `potential.gap` to one it gives way: a
    queue that presses the same way would close the gap of the first pair. The sum is shortened to what the wheels can do.
    """
    fx, fy = gradient_force(own.x, own.y, others, potential, potential.d)
    gap = potential.gap
    share = 1.0
    if gap > 0.0:
        bx, by = braking(own, others, potential, top)
        fx, fy = fx + bx, fy + by
        nearest = min((hypot(own.x - x, own.y - y) for x, y, _, _ in others), default=2.0 * gap)
        share = min(1.0, max(0.0, nearest - gap) / gap)
    if fx == 0.0 and fy == 0.0 and share == 1.0:
        return u
    size = hypot(*u)
    scale = share * (top / size if size > top else 1.0)
    ux, uy = scale * u[0] + fx, scale * u[1] + fy
    return within_reach(ux, uy, own, top) if gap > 0.0 else (ux, uy)


def anyone_within(x: float, y: float, others: Iterable[Placed], reach: float) -> bool:
    """Whether a robot is nearer than `reach`."""
    reach2 = reach**2
    return any((x - ox) ** 2 + (y - oy) ** 2 < reach2 for ox, oy, _, _ in others)
