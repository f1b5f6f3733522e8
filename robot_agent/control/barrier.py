"""A barrier between robots: the acceleration nearest to what a law asks for that lets nobody come too close.

Two robots that both can brake with a stop `gap` apart as long as, r being their distance and c how fast it shrinks,
    h = s(r) - c >= 0,    s(r) = sqrt(4 a (r - gap)).
h' >= -kappa h keeps it so for ever. With e the unit vector away from the other and v_t the sideways speed between them,
    h' = -s'(r) c + v_t^2 / r + e . (u_i - u_j),
and each robot answers for one half: e . u_i >= (s'(r) c - v_t^2 / r - kappa h) / 2, which needs nothing of the other but
its place and velocity. Each such condition is a half plane of accelerations, and what the wheels can give is four more.

Source: safety barrier certificates, L. Wang, A. D. Ames, M. Egerstedt, Safety Barrier Certificates for Collisions-Free
Multirobot Systems, IEEE Trans. Robotics 33(3), 2017; there with h from the same braking distance and kappa h^3.

The promise holds for hands that follow u. A robot that turns cannot always (its wheels saturate), nor one with more
neighbours around it than directions to go: then the most urgent neighbour comes first, and the others come a little
nearer than `gap` (six robots that are pulled to one point: 0.77 m for 0.8 m, two never). What remains was measured: see
docs/results.md. Robots that sense each other have a guard behind it that promises less and keeps it
(robot_agent.control.guard).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import cos, hypot, sin, sqrt

from protocol.scenario.laws import Repulsion
from robot_agent.hand import Own, within_reach
from robot_agent.interfaces import Point
from robot_agent.neighbours import Placed

Plane = tuple[float, float, float]  # n_x, n_y, b: accelerations with n . u <= b, |n| = 1
SLACK = 1e-9
RATE = 2.0  # kappa, 1/s
FAST = 3.0  # m/s: from where h = s - c is far from 0, whatever two robots do
BLEND = 0.05  # m: nearer than gap + BLEND s(r) goes on as a straight line, for its slope there is without bound


def apart(own: Own, others: Iterable[Placed], potential: Repulsion) -> list[tuple[float, Plane]]:
    """The conditions of the robots in reach, each as h, m/s, and a half plane for u_i."""
    gap, a = potential.gap, potential.brake
    reach2 = (gap + FAST * FAST / (4.0 * a)) ** 2  # s = FAST
    found = []
    for x, y, vx, vy in others:
        dx, dy = own.x - x, own.y - y
        if dx * dx + dy * dy > reach2:
            continue
        r = max(hypot(dx, dy), 1e-6)
        s, slope = safe_speed(r, gap, a)
        ex, ey = dx / r, dy / r
        wx, wy = own.vx - vx, own.vy - vy
        closing = -(wx * ex + wy * ey)
        sideways2 = max(wx * wx + wy * wy - closing * closing, 0.0)
        h = s - closing
        least = 0.5 * (slope * closing - sideways2 / r - RATE * h)
        found.append((h, (-ex, -ey, -least)))
    return found


def safe_speed(r: float, gap: float, a: float) -> tuple[float, float]:
    """s(r), m/s, and its slope, 1/s."""
    if r > gap + BLEND:
        s = sqrt(4.0 * a * (r - gap))
        return s, 2.0 * a / s
    s = sqrt(4.0 * a * BLEND)
    slope = 2.0 * a / s
    return s + slope * (r - gap - BLEND), slope


def wheels(own: Own, top: float) -> tuple[Plane, ...]:
    """What the wheels can give: |forward| + axle/(2L) |sideways| <= `top` around what turning alone gives (1.10)."""
    c, s, w = cos(own.theta), sin(own.theta), own.lever
    size = hypot(1.0, w)
    forward, sideways = -own.swing, own.nu * own.omega
    planes = []
    for one, two in ((1.0, w), (1.0, -w), (-1.0, w), (-1.0, -w)):
        n_x, n_y = (one * c - two * s) / size, (one * s + two * c) / size
        planes.append((n_x, n_y, (top + one * forward + two * sideways) / size))
    return tuple(planes)


def nearest(u: Point, planes: Sequence[Plane]) -> Point | None:
    """The point nearest to u in all half planes; None where they have none in common.

    It is u itself, or the foot of u on one line, or where two lines meet.
    """
    if inside(u, planes):
        return u
    best: Point | None = None
    least = float("inf")
    feet = [(u[0] + m * nx, u[1] + m * ny) for nx, ny, b in planes if (m := b - nx * u[0] - ny * u[1]) < 0.0]
    for point in (*feet, *corners(planes)):
        away = (point[0] - u[0]) ** 2 + (point[1] - u[1]) ** 2
        if away < least and inside(point, planes):
            best, least = point, away
    return best


def corners(planes: Sequence[Plane]) -> Iterable[Point]:
    """Where the edges of half planes meet."""
    for k, (ax, ay, a) in enumerate(planes):
        for bx, by, b in planes[:k]:
            det = ax * by - ay * bx
            if abs(det) > 1e-6:
                yield (a * by - b * ay) / det, (ax * b - bx * a) / det


def inside(u: Point, planes: Iterable[Plane]) -> bool:
    return all(nx * u[0] + ny * u[1] <= b + SLACK * (1.0 + abs(b)) for nx, ny, b in planes)


def certify(u: Point, own: Own, others: Iterable[Placed], potential: Repulsion, top: float) -> Point:
    """The u_i nearest to `u` that keeps the robot clear of all others, m/s^2; `u` itself where that is safe.

    Where not everybody can be satisfied the ones with the smallest h are; where not even one can, as far as the wheels
    go in the direction away from it.
    """
    conditions = apart(own, others, potential)
    if not conditions:
        return u
    u = within_reach(u[0], u[1], own, top)  # what clips, clips each wheel for itself and changes the direction
    if inside(u, [plane for _, plane in conditions]):
        return u
    conditions.sort()
    limits = wheels(own, top)
    planes = [plane for _, plane in conditions]
    for count in range(len(planes), 0, -1):
        safe = nearest(u, (*limits, *planes[:count]))
        if safe is not None:
            return safe
    nx, ny, _ = planes[0]
    return min(corners(limits), key=lambda p: nx * p[0] + ny * p[1] + (0.0 if inside(p, limits) else 1e9))
