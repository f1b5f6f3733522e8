"""The unicycle: rest, the hand-position inverse (1.10)-(1.12), limits, brakes, refinement."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from protocol.scenario.sections import Body, Timing
from world_server.bodies import Bodies

Array = NDArray[np.float64]
BODY = Body()
angles = st.floats(-7.0, 7.0)


def one_robot(theta: float, nu: float, omega: float, timing: Timing, body: Body = BODY) -> Bodies:
    """A robot at (3, -2) that is moving already."""
    bodies = Bodies(body, timing, [3.0], [-2.0], [theta])
    bodies.robots[0].nu, bodies.robots[0].omega = nu, omega
    return bodies


def torques_for(u: tuple[float, float], theta: float, nu: float, omega: float) -> tuple[float, float]:
    """Wheel torques (1.11), (1.12) of the force and torque (1.10) for the hand acceleration u."""
    m, length, inertia, c, s = BODY.mass, BODY.hand, BODY.inertia, math.cos(theta), math.sin(theta)
    matrix = np.array([[c / m, -length / inertia * s], [s / m, length / inertia * c]])
    drift = np.array([-nu * omega * s - length * omega**2 * c, nu * omega * c - length * omega**2 * s])
    force, torque = np.linalg.solve(matrix, np.array(u) - drift)
    per = BODY.wheel_inertia / BODY.wheel_radius
    turn = torque * BODY.axle / (2 * inertia)
    return per * (force / m - turn), per * (force / m + turn)


def test_zero_torque_at_rest_stays_at_rest() -> None:
    bodies = Bodies(BODY, Timing(), [1.0, 5.0], [2.0, -7.0], [0.3, 4.0])
    before = bodies.hands()
    for _ in range(10):
        path = bodies.step([0.0, 0.0], [0.0, 0.0])
    assert bodies.x.tolist() == [1.0, 5.0]
    assert bodies.y.tolist() == [2.0, -7.0]
    assert bodies.theta.tolist() == [0.3, 4.0]
    assert bodies.travelled.tolist() == [0.0, 0.0]
    assert path.track[:, -1].tolist() == [complex(*hand) for hand in before]
    assert np.all(bodies.hand_velocities() == 0.0)


@given(
    theta=angles,
    nu=st.floats(-0.6, 0.6),
    omega=st.floats(-1.0, 1.0),
    u=st.tuples(st.floats(-0.25, 0.25), st.floats(-0.05, 0.05)),
)
def test_the_hand_accelerates_as_1_10_asks_while_nothing_saturates(
    theta: float, nu: float, omega: float, u: tuple[float, float]
) -> None:
    short = 1e-4
    bodies = one_robot(theta, nu, omega, Timing(tick=short, substep=short))
    # u along and across the heading, within what the wheels can do besides cancelling the drift
    asked = complex(*u) * complex(math.cos(theta), math.sin(theta))
    tau_l, tau_r = torques_for((asked.real, asked.imag), theta, nu, omega)
    assume(max(abs(tau_l), abs(tau_r)) <= BODY.max_torque)
    v0 = bodies.hand_velocities()[0]
    bodies.step([tau_l], [tau_r])
    accelerated = (bodies.hand_velocities()[0] - v0) / short
    np.testing.assert_allclose(accelerated, [asked.real, asked.imag], atol=5e-3)


@given(theta=angles, nu=st.floats(-0.8, 0.8), omega=st.floats(-1.57, 1.57))
def test_the_hand_moves_with_the_hand_velocity(theta: float, nu: float, omega: float) -> None:
    short = 1e-5
    bodies = one_robot(theta, nu, omega, Timing(tick=short, substep=short))
    before, v = bodies.hands()[0], bodies.hand_velocities()[0]
    np.testing.assert_allclose(before, [3.0 + 0.12 * math.cos(theta), -2.0 + 0.12 * math.sin(theta)], atol=1e-14)
    bodies.step([0.0], [0.0])
    np.testing.assert_allclose((bodies.hands()[0] - before) / short, v, atol=1e-4)


@settings(deadline=None)
@given(
    torques=st.lists(st.tuples(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0)), min_size=1, max_size=30),
    saturation=st.sampled_from(["per-wheel", "proportional"]),
)
def test_speed_turn_and_torque_limits_hold(torques: list[tuple[float, float]], saturation: str) -> None:
    body = Body(saturation=saturation)  # type: ignore[arg-type]
    bodies = Bodies(body, Timing(), [0.0], [0.0], [0.0])
    fastest = body.wheel_radius * body.max_torque / body.wheel_inertia * 0.05  # of one wheel's rim in a tick, m/s
    for tau_l, tau_r in torques:
        nu, omega = bodies.nu[0], bodies.omega[0]
        path = bodies.step([tau_l], [tau_r])
        assert abs(bodies.nu[0]) <= body.max_speed
        assert abs(bodies.omega[0]) <= body.max_turn
        assert abs(bodies.nu[0] - nu) <= fastest * (1 + 1e-9)
        assert abs(bodies.omega[0] - omega) * body.axle / 2 <= fastest * (1 + 1e-9)
        assert path.ways[0] <= 0.05 * math.hypot(body.max_speed, body.hand * body.max_turn)


def test_full_torque_reaches_the_limits_and_no_more() -> None:
    for sign in (1.0, -1.0):
        straight, spin = one_robot(0.0, 0.0, 0.0, Timing()), one_robot(0.0, 0.0, 0.0, Timing())
        for _ in range(100):
            straight.step([sign], [sign])
            spin.step([-sign], [sign])
        assert straight.nu[0] == sign * BODY.max_speed
        assert spin.omega[0] == sign * BODY.max_turn
        before = spin.theta[0]
        spin.step([-sign], [sign])
        assert spin.theta[0] - before == pytest.approx(sign * BODY.max_turn * 0.05)


def test_saturation_clips_each_wheel_or_keeps_the_proportion() -> None:
    by_wheel, together = (one_robot(0.0, 0.0, 0.0, Timing(), Body(saturation=s)) for s in ("per-wheel", "proportional"))
    by_wheel.step([0.4], [3.2])
    together.step([0.4], [3.2])
    gain = BODY.wheel_radius / BODY.wheel_inertia * 0.05
    assert by_wheel.nu[0] == pytest.approx(gain * (0.4 + 0.8) / 2)
    assert together.nu[0] == pytest.approx(gain * (0.1 + 0.8) / 2)
    assert together.omega[0] == pytest.approx(gain * (0.8 - 0.1) / BODY.axle)


def test_equal_torques_drive_straight_and_opposite_ones_turn_on_the_spot() -> None:
    straight, spin = (one_robot(0.4, 0.0, 0.0, Timing()) for _ in range(2))
    for _ in range(30):
        straight.step([0.3], [0.3])
        spin.step([-0.1], [0.1])
    a, t = BODY.wheel_radius * 0.3 / BODY.wheel_inertia, 30 * 0.05
    assert straight.theta[0] == 0.4
    assert straight.travelled[0] == pytest.approx(0.5 * a * t**2, rel=1e-12)
    assert straight.x[0] == pytest.approx(3.0 + 0.5 * a * t**2 * math.cos(0.4), rel=1e-12)
    assert (spin.x[0], spin.y[0]) == (3.0, -2.0)
    assert spin.theta[0] == pytest.approx(0.4 + 0.5 * (2 * BODY.wheel_radius * 0.1 / 0.381 / 0.07) * t**2, rel=1e-12)
    assert spin.travelled[0] == pytest.approx(BODY.hand * (spin.theta[0] - 0.4), rel=1e-3)


def exact_end(tau_l: float, tau_r: float, theta: float, nu: float, omega: float, seconds: float) -> Array:
    """Centre and heading by an integrator with a tight tolerance; no limit is met."""
    a = BODY.wheel_radius * (tau_l + tau_r) / (2 * BODY.wheel_inertia)
    alpha = BODY.wheel_radius * (tau_r - tau_l) / (BODY.axle * BODY.wheel_inertia)

    def rate(t: float, state: Array) -> list[float]:
        speed = nu + a * t
        return [speed * math.cos(state[2]), speed * math.sin(state[2]), omega + alpha * t]

    end: Array = solve_ivp(rate, (0.0, seconds), [3.0, -2.0, theta], rtol=1e-11, atol=1e-12).y[:, -1]
    return end


def test_the_error_falls_with_the_square_of_the_substep() -> None:
    tau_l, tau_r = -0.05, 0.12
    exact = exact_end(tau_l, tau_r, 0.3, 0.2, -1.0, 1.0)
    errors = []
    for substep in (0.1, 0.05, 0.025):
        bodies = one_robot(0.3, 0.2, -1.0, Timing(tick=1.0, substep=substep))
        bodies.step([tau_l], [tau_r])
        errors.append(math.hypot(bodies.x[0] - exact[0], bodies.y[0] - exact[1]))
        assert bodies.theta[0] == pytest.approx(exact[2], abs=1e-9)
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.15)


def test_shorter_substeps_change_the_way_by_little_even_when_limits_are_met() -> None:
    ends = []
    for substep in (0.01, 0.001):
        bodies = one_robot(0.3, 0.6, 1.2, Timing(substep=substep))
        for k in range(60):
            bodies.step([0.8 * math.sin(0.2 * k)], [0.8 * math.cos(0.15 * k)])
        ends.append(bodies.hands()[0])
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-3)


def test_the_path_starts_where_the_last_one_ended_and_ends_at_the_hands() -> None:
    bodies = Bodies(BODY, Timing(tick=0.05, substep=0.02), [0.0, 9.0], [0.0, 9.0], [0.0, 1.0])
    first = bodies.step([0.5, 0.1], [0.4, 0.2])
    second = bodies.step([0.5, 0.1], [0.4, 0.2])
    assert first.track.shape == (2, 2)
    assert first.h == 0.05
    assert second.track[:, 0].tolist() == first.track[:, -1].tolist()
    assert second.track[:, -1].tolist() == [complex(*hand) for hand in bodies.hands()]
    np.testing.assert_allclose(bodies.travelled, np.add(first.ways, second.ways))


def test_relabelling_the_robots_relabels_the_answer() -> None:
    rng = np.random.default_rng(1)
    order = np.array([2, 0, 3, 1])
    poses, torques = rng.uniform(-3, 3, (3, 4)), rng.uniform(-1, 1, (2, 4))
    a = Bodies(BODY, Timing(), *poses)
    b = Bodies(BODY, Timing(), *poses[:, order])
    for _ in range(20):
        a.step(*torques)
        b.step(*torques[:, order])
    assert a.hands()[order].tolist() == b.hands().tolist()
    assert a.travelled[order].tolist() == b.travelled.tolist()


@given(nu=st.floats(-0.8, 0.8), omega=st.floats(-1.57, 1.57), saturation=st.sampled_from(["per-wheel", "proportional"]))
def test_a_braking_robot_comes_to_rest_as_fast_as_its_wheels_can_without_rolling_back(
    nu: float, omega: float, saturation: str
) -> None:
    body = Body(saturation=saturation)  # type: ignore[arg-type]
    bodies = one_robot(0.5, nu, omega, Timing(), body)
    bodies.brake([True])
    rim = abs(nu) + body.axle / 2 * abs(omega)
    ticks = rim / (body.wheel_radius * body.max_torque / body.wheel_inertia * 0.05)
    lever = body.axle / 2
    rims = [nu - lever * omega, nu + lever * omega]
    for _ in range(math.ceil(ticks) + 1):
        bodies.step([0.8], [0.7])  # it does not listen
        left, right = bodies.nu[0] - lever * bodies.omega[0], bodies.nu[0] + lever * bodies.omega[0]
        assert left * rims[0] >= -1e-15
        assert right * rims[1] >= -1e-15
        assert abs(left) <= abs(rims[0]) + 1e-12
        assert abs(right) <= abs(rims[1]) + 1e-12
    assert abs(bodies.nu[0]) < 1e-12
    assert abs(bodies.omega[0]) < 1e-12


def test_brakes_hold_only_the_robots_of_the_mask_and_only_until_the_next_call() -> None:
    def fresh() -> Bodies:
        bodies = Bodies(BODY, Timing(), [0.0, 5.0], [0.0, 0.0], [0.0, 1.0])
        for robot in bodies.robots:
            robot.nu = 0.5
        return bodies

    braked, free = fresh(), fresh()
    braked.brake([False, True])
    for _ in range(20):
        braked.step([0.1, 0.1], [0.1, 0.2])
        free.step([0.1, 0.1], [0.1, 0.2])
    assert braked.hands()[0].tolist() == free.hands()[0].tolist()
    assert abs(braked.nu[1]) < 1e-12
    assert free.nu[1] > 0.5
    braked.brake([False, False])
    braked.step([0.1, 0.1], [0.1, 0.1])
    assert braked.nu[1] == pytest.approx(BODY.wheel_radius * 0.1 / BODY.wheel_inertia * 0.05)
