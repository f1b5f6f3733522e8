"""The barrier between robots: the nearest safe acceleration, and real bodies that never come too close."""

import math
import random
from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.messages import Reading
from protocol.scenario.laws import Repulsion
from protocol.scenario.sections import Body, Timing
from robot_agent.control.barrier import apart, certify, corners, inside, nearest, safe_speed, wheels
from robot_agent.control.repulsion import keep_clear
from robot_agent.hand import Own, top_acceleration, wheel_torques, within_reach
from world_server.bodies import Bodies, Unicycle

BODY = Body()
TOP = top_acceleration(BODY)
POTENTIAL = Repulsion(d=2.0)
angle = st.floats(-3.2, 3.2)
speed = st.floats(-0.8, 0.8)


def own_of(robot: Unicycle, tick: int = 0) -> Own:
    return Own(Reading(0, tick, 0.05 * tick, robot.x, robot.y, robot.theta, robot.nu, robot.omega, 0, 0, 0), BODY)


def moving(nu: float, omega: float, theta: float) -> Own:
    return Own(Reading(0, 0, 0.0, 0.0, 0.0, theta, nu, omega, 0, 0, 0), BODY)


half_planes = st.lists(
    st.tuples(angle, st.floats(0.0, 2.0)).map(lambda p: (math.cos(p[0]), math.sin(p[0]), p[1])), min_size=1, max_size=6
)


@given(st.tuples(st.floats(-5, 5), st.floats(-5, 5)), half_planes, st.lists(st.tuples(angle, st.floats(0, 4)), max_size=20))
def test_no_point_of_the_half_planes_is_nearer(u, planes, tries):
    found = nearest(u, planes)  # they all hold the origin, so there is one
    assert found is not None
    assert inside(found, planes)
    away = math.hypot(found[0] - u[0], found[1] - u[1])
    for turn, way in tries:
        point = (found[0] + way * math.cos(turn), found[1] + way * math.sin(turn))
        if inside(point, planes):
            assert math.hypot(point[0] - u[0], point[1] - u[1]) >= away - 1e-6


def test_half_planes_that_share_nothing_have_no_nearest_point():
    assert nearest((0.0, 0.0), [(1.0, 0.0, -1.0), (-1.0, 0.0, -1.0)]) is None


@given(speed, st.floats(-1.5, 1.5), angle, st.floats(-2, 2), st.floats(-2, 2))
def test_what_the_wheels_can_give_needs_no_torque_beyond_the_motors(nu, omega, theta, ux, uy):
    own = moving(nu, omega, theta)
    limits = wheels(own, TOP)
    given_up = nearest((ux, uy), limits)
    assert given_up is not None
    assert max(map(abs, wheel_torques(*given_up, own, BODY))) <= BODY.max_torque * (1 + 1e-6)
    for corner in corners(limits):
        if inside(corner, limits):
            assert max(map(abs, wheel_torques(*corner, own, BODY))) == pytest.approx(BODY.max_torque)


@given(st.floats(0.1, 6.0))
def test_the_safe_speed_is_what_both_can_brake(r):
    s, slope = safe_speed(r, 0.8, 0.3)
    if r > 0.85:
        assert s**2 / (4 * 0.3) == pytest.approx(r - 0.8)  # each brakes its half of the closing speed
    ahead, _ = safe_speed(r + 1e-6, 0.8, 0.3)
    assert (ahead - s) / 1e-6 == pytest.approx(slope, rel=1e-3, abs=1e-5)


@given(st.floats(9.0, 60.0), angle, st.floats(-9, 9), st.floats(-9, 9))
def test_nobody_near_leaves_the_law_as_it_is(distance, turn, ux, uy):
    there = (0.12 + distance * math.cos(turn), distance * math.sin(turn), 0.0, 0.0)
    assert keep_clear((ux, uy), moving(0.0, 0.0, 0.0), [there], POTENTIAL, TOP) == (ux, uy)


@given(speed, angle, st.floats(1.0, 3.0), angle, speed, speed, st.floats(-2, 2), st.floats(-2, 2))
def test_one_other_robot_gets_its_condition_or_the_wheels_do_all_they_can(nu, theta, r, turn, vx, vy, ux, uy):
    own = moving(nu, 0.0, theta)
    other = [(own.x + r * math.cos(turn), own.y + r * math.sin(turn), vx, vy)]
    safe = certify((ux, uy), own, other, POTENTIAL, TOP)
    [(_, plane)] = apart(own, other, POTENTIAL) or [(0.0, (0.0, 0.0, 0.0))]
    if not inside(safe, [plane]):
        reached = [plane[0] * x + plane[1] * y for x, y in corners(wheels(own, TOP)) if inside((x, y), wheels(own, TOP))]
        assert plane[0] * safe[0] + plane[1] * safe[1] == pytest.approx(min(reached))
    elif inside(short := within_reach(ux, uy, own, TOP), [plane]):
        assert safe in ((ux, uy), short)


@pytest.mark.parametrize("gather", [True, False], ids=["to one point", "across each other"])
@pytest.mark.parametrize("robots", [2, 6])
@pytest.mark.parametrize("seed", range(3))
def test_robots_that_are_pulled_together_stay_apart(robots, seed, gather):
    draw = random.Random(seed)
    on_circle = [2 * math.pi * (i + draw.uniform(-0.2, 0.2)) / robots for i in range(robots)]
    bodies = Bodies(
        BODY, Timing(), [5 * math.cos(p) for p in on_circle], [5 * math.sin(p) for p in on_circle],
        [draw.uniform(-3, 3) for _ in on_circle],
    )  # fmt: skip
    goals = [(0.0 if gather else -5 * math.cos(p), 0.0 if gather else -5 * math.sin(p)) for p in on_circle]
    closest = math.inf
    for tick in range(600):
        owns = [own_of(robot, tick) for robot in bodies.robots]
        torques = []
        for own, goal in zip(owns, goals, strict=True):
            u = (-4 * (own.x - goal[0]) - 2 * own.vx, -4 * (own.y - goal[1]) - 2 * own.vy)
            others = [(o.x, o.y, o.vx, o.vy) for o in owns if o is not own]
            torques.append(wheel_torques(*keep_clear(u, own, others, POTENTIAL, TOP), own, BODY))
        bodies.step([left for left, _ in torques], [right for _, right in torques])
        closest = min(closest, *(math.dist(a, b) for a, b in combinations(bodies.hands(), 2)))
    assert closest > 0.6
