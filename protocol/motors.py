"""The motors of a body: what they give, and what stops a wheel.

Rules: pure. World and robots share these few lines because the guard's promise (robot_agent/control/guard.py) rests on their
being the same: a robot reckons with the way that the world makes it brake.
"""

from __future__ import annotations

from protocol.scenario.sections import Body


def limited(tau_left: float, tau_right: float, body: Body) -> tuple[float, float]:
    """The torques that the motors give when asked for these, N m."""
    most = body.max_torque
    if body.saturation == "proportional":
        largest = max(abs(tau_left), abs(tau_right))
        scale = most / largest if largest > most else 1.0
        return tau_left * scale, tau_right * scale
    return max(-most, min(most, tau_left)), max(-most, min(most, tau_right))


def stopping_torques(nu: float, omega: float, body: Body, dt: float) -> tuple[float, float]:
    """Torques that stop each wheel within `dt`, or as soon as it can be, N m.

    A wheel's rim obeys v' = b tau / J_wheel on its own, so each wheel is stopped on its own.
    """
    sideways, per_speed, most = 0.5 * body.axle * omega, -body.wheel_inertia / (body.wheel_radius * dt), body.max_torque
    left, right = per_speed * (nu - sideways), per_speed * (nu + sideways)
    return max(-most, min(most, left)), max(-most, min(most, right))
