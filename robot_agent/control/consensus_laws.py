"""The consensus-based laws of chapter 5, each once: for one robot, from what it hears.

Rules: plain floats, both axes at once, no state. All of (5.1)-(5.7) have the form

    u_i = (what the reference asks) + phi_i + sig(phi_i)^alpha

and differ in phi_i. A formation is taken off beforehand (`relative`): with xbar_i = x_i - h_i and vbar_i = v_i - h_i' the
sums of (5.1), (5.3), (5.4) and (5.6) are one, `agreement`. It is added up from left to right, so that equal numbers
give equal bits.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import cos, pi, sin
from typing import NamedTuple, Protocol

from robot_agent.sig import Step

Vector = tuple[float, float]


class Moving(Protocol):
    """Whatever has a position and a velocity: `Own`, `Shared`, `Motion`."""

    @property
    def x(self) -> float: ...
    @property
    def y(self) -> float: ...
    @property
    def vx(self) -> float: ...
    @property
    def vy(self) -> float: ...


class Motion(NamedTuple):
    """A robot's motion as seen from its place in the formation: xbar = x - h, m, and vbar = v - h', m/s."""

    x: float
    y: float
    vx: float
    vy: float


Heard = Iterable[tuple[float, Motion]]  # (a_ij, motion of robot j as seen from its own place)


def relative(robot: Moving, h: Vector = (0.0, 0.0), h_dot: Vector = (0.0, 0.0)) -> Motion:
    """xbar = x - h and vbar = v - h' of a robot whose place in the formation is h, m, moving with h', m/s."""
    return Motion(robot.x - h[0], robot.y - h[1], robot.vx - h_dot[0], robot.vy - h_dot[1])


def agreement(own: Motion, heard: Heard, beta: float, gamma: float, phi: Vector = (0.0, 0.0)) -> Vector:
    """How far a robot is from agreeing with its neighbours, added to `phi`.

    Thesis section 5.2.2, inside (5.1) and, with a formation taken off, (5.3):
        phi_i = sum_j a_ij (beta (xbar_j - xbar_i) + gamma (vbar_j - vbar_i))

    Args:
        beta: position gain, 1/s^2 (m/s^2 per m), > 0.
        gamma: velocity gain, 1/s, > 0.
    Returns: phi_i, m/s^2 per axis.
    """
    phi_x, phi_y = phi
    x, y, vx, vy = own
    for a_ij, j in heard:
        phi_x += a_ij * (beta * (j.x - x) + gamma * (j.vx - vx))
        phi_y += a_ij * (beta * (j.y - y) + gamma * (j.vy - vy))
    return phi_x, phi_y


def parallel(own: Motion, heard: Heard, v_c: Vector, beta: float, gamma: float, lam: float) -> Vector:
    """phi_i of the parallel motion.

    Thesis section 5.2.3, (5.4), and (5.5) where each robot has its own v_ic:
        phi_i = agreement + lambda (v_c - v_i),      u_i = v_c' + phi_i + sig(phi_i)^alpha

    Args:
        v_c: reference velocity, m/s.
        lam: lambda, 1/s, > 0.
    """
    start = (lam * (v_c[0] - own.vx), lam * (v_c[1] - own.vy))
    return agreement(own, heard, beta, gamma, start)


def circular(
    own: Motion, heard: Heard, centre: Vector, beta: float, gamma: float, lam1: float, lam2: float
) -> Vector:
    """phi_i of the circular motion, all motions seen from the places h_i(t) on the circles.

    Thesis section 5.2.4, (5.6), and (5.7) where each robot has its own h^ic:
        phi_i = agreement + lambda_1 (h_i' - v_i) + lambda_2 (h^c - (x_i - h_i)),   u_i = h_i'' + phi_i + sig(phi_i)^alpha

    Args:
        centre: h^c, m.
        lam1: lambda_1, 1/s, > 0.
        lam2: lambda_2, 1/s^2, > 0.
    """
    start = (lam2 * (centre[0] - own.x) - lam1 * own.vx, lam2 * (centre[1] - own.y) - lam1 * own.vy)
    return agreement(own, heard, beta, gamma, start)


def respond(phi: Vector, alpha: float, step: Step, dt_k: float) -> Vector:
    """phi_i + sig(phi_i)^alpha, m/s^2, by a sampled-data `step` of robot_agent.sig (dt_k = 0: as printed)."""
    return step(phi[0], 1.0, 1.0, alpha, dt_k), step(phi[1], 1.0, 1.0, alpha, dt_k)


def formation(radius: float, sectors: int, robots: int) -> list[Vector]:
    """h_i = radius (cos(2 pi i / sectors + pi/6), sin(...)), i = 1 ... `robots` (section 5.3, Table 5.3), m."""
    return [
        (radius * cos(2 * pi * i / sectors + pi / 6), radius * sin(2 * pi * i / sectors + pi / 6))
        for i in range(1, robots + 1)
    ]


def orbit(radius: float, turn: float, theta: float) -> tuple[Vector, Vector]:
    """h_i = r (cos theta_i, sin theta_i) and h_i' for theta_i' = omega_0 = `turn`, rad/s (5.6); h_i'' = -omega_0^2 h_i."""
    h_x, h_y = radius * cos(theta), radius * sin(theta)
    return (h_x, h_y), (-turn * h_y, turn * h_x)
