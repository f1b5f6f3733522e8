"""The hand position: the point L ahead of the wheel axis, which moves as a double integrator (1.7).

Thesis section 1.1.3, (1.8)-(1.12).
"""

from __future__ import annotations

from math import cos, hypot, sin

from protocol.messages import Reading
from protocol.scenario.sections import Body


class Own:
    """What a robot knows of its own motion at one tick, in hand coordinates, and what it senses there."""

    __slots__ = ("before", "concentration", "lever", "nu", "omega", "swing", "t", "theta", "tick", "vx", "vy", "wind_x",
                 "wind_y", "x", "y")  # fmt: skip

    def __init__(self, reading: Reading, body: Body, before: int | None = None) -> None:
        """`before`: tick of the reading before this one; None: the tick before, as always in lock-step."""
        L = body.hand
        c, s = cos(reading.theta), sin(reading.theta)
        nu, omega = reading.nu, reading.omega
        self.lever = 0.5 * body.axle / L  # what a sideways acceleration costs the wheels, compared with a forward one
        self.swing = L * omega * omega  # the hand's acceleration towards the axle by turning alone, m/s^2
        self.tick = reading.tick
        self.before = reading.tick - 1 if before is None else before
        self.t = reading.t
        self.theta = reading.theta
        self.nu = nu
        self.omega = omega
        self.x = reading.x + L * c  # (1.8)
        self.y = reading.y + L * s
        self.vx = nu * c - L * omega * s  # (1.9)
        self.vy = nu * s + L * omega * c
        self.wind_x = reading.wind_x
        self.wind_y = reading.wind_y
        self.concentration = reading.concentration

    def due(self, every: int) -> bool:
        """Whether something that is done once in `every` ticks is due: such an instant has come since the last reading."""
        return self.tick // every > self.before // every


def wheel_torques(ux: float, uy: float, own: Own, body: Body) -> tuple[float, float]:
    """Wheel torques that give the hand the acceleration u while nothing saturates.

    Thesis (1.10): p = B^-1 [u - (-nu omega sin - L omega^2 cos, nu omega cos - L omega^2 sin)], p = (F, tau);
    (1.11), (1.12): tau_l,r = J_wheel/b (F/m -+ tau l / (2 J)).

    Args:
        ux, uy: hand acceleration u_i, m/s^2.
    Returns:
        tau_left, tau_right, N m, not yet limited: the body clips them.
    """
    L, nu, omega = body.hand, own.nu, own.omega
    c, s = cos(own.theta), sin(own.theta)
    bx = ux + nu * omega * s + L * omega * omega * c
    by = uy - nu * omega * c + L * omega * omega * s
    forward = c * bx + s * by  # F / m
    turn = (c * by - s * bx) / L  # tau / J
    scale = body.wheel_inertia / body.wheel_radius
    half = 0.5 * body.axle * turn
    return scale * (forward - half), scale * (forward + half)


def within_reach(ux: float, uy: float, own: Own, top: float) -> tuple[float, float]:
    """u_i shortened so that no wheel clips, m/s^2: wheels that clip, each for itself, change its direction.

    By (1.10)-(1.12) the wheels ask for |forward| + axle/(2L) |sideways| <= `top`, the turning terms left out.
    """
    c, s = cos(own.theta), sin(own.theta)
    asked = abs(c * ux + s * uy) + own.lever * abs(c * uy - s * ux)
    scale = top / asked if asked > top else 1.0
    return scale * ux, scale * uy


def top_acceleration(body: Body) -> float:
    """Largest forward acceleration that the wheels can give, m/s^2."""
    return body.max_torque * body.wheel_radius / body.wheel_inertia


def fastest_hand(body: Body) -> float:
    """Largest speed of a hand, m/s."""
    return hypot(body.max_speed, body.hand * body.max_turn)


def strongest_push(body: Body) -> float:
    """Largest acceleration of a hand over the ground, m/s^2: by the wheels, |forward| + axle/(2L) |sideways| <= top, on
    top of what turning alone gives, L omega^2 backwards and nu omega sideways."""
    top, swing, drift = top_acceleration(body), body.hand * body.max_turn**2, body.max_speed * body.max_turn
    return max(hypot(top + swing, drift), hypot(swing, 2.0 * top * body.hand / body.axle + drift))
