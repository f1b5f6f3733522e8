"""Hand position (1.7)-(1.12)."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.messages import Reading
from protocol.scenario.sections import Body
from robot_agent.hand import Own, top_acceleration, wheel_torques

BODY = Body()
motions = st.tuples(
    st.floats(-math.pi, math.pi),
    st.floats(-0.8, 0.8),
    st.floats(-1.57, 1.57),
    st.floats(-0.2, 0.2),
    st.floats(-0.2, 0.2),
)


def own(theta: float, nu: float, omega: float) -> Own:
    return Own(Reading(0, 0, 0.0, 1.0, 2.0, theta, nu, omega, 1.0, 0.0, 0.0), BODY)


@given(motions)
def test_wheel_torques_give_the_hand_the_acceleration_asked_for(motion):
    """(1.10)-(1.12) inverted by hand: v_i = R(theta)(nu, L omega), differentiated."""
    theta, nu, omega, ux, uy = motion
    state = own(theta, nu, omega)
    left, right = wheel_torques(ux, uy, state, BODY)
    b, J, axle, L = BODY.wheel_radius, BODY.wheel_inertia, BODY.axle, BODY.hand
    nu_dot = (left + right) / 2 * b / J
    omega_dot = (right - left) / axle * b / J
    c, s = math.cos(theta), math.sin(theta)
    ax = nu_dot * c - nu * omega * s - L * omega_dot * s - L * omega**2 * c
    ay = nu_dot * s + nu * omega * c + L * omega_dot * c - L * omega**2 * s
    assert (ax, ay) == pytest.approx((ux, uy), abs=1e-9)


@given(motions)
def test_hand_velocity_is_the_derivative_of_the_hand_position(motion):
    theta, nu, omega, *_ = motion
    dt = 1e-6
    now = own(theta, nu, omega)
    mid = theta + omega * dt / 2
    x, y = 1.0 + nu * dt * math.cos(mid), 2.0 + nu * dt * math.sin(mid)
    later = Own(Reading(0, 0, 0.0, x, y, theta + omega * dt, nu, omega, 0.0, 0.0, 0.0), BODY)
    assert ((later.x - now.x) / dt, (later.y - now.y) / dt) == pytest.approx((now.vx, now.vy), abs=1e-5)


def test_top_acceleration_is_what_full_torque_gives():
    left, right = wheel_torques(top_acceleration(BODY), 0.0, own(0.0, 0.0, 0.0), BODY)
    assert (left, right) == pytest.approx((BODY.max_torque, BODY.max_torque))
