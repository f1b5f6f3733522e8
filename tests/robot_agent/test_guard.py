"""The guard: real bodies that are driven at each other by all means never come nearer than it promises."""

import math
from dataclasses import dataclass, field
from itertools import combinations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from protocol.messages import Reading
from protocol.scenario import RobotScenario, robot_view
from protocol.scenario.load import load_scenario
from protocol.scenario.sections import Body, Timing
from robot_agent.control.guard import GIVE, Guard, range_needed, way
from robot_agent.control.repulsion import keep_clear
from robot_agent.control.stops import Stops
from robot_agent.hand import Own, fastest_hand, top_acceleration, wheel_torques
from robot_agent.proximity import Proximity
from world_server.bodies import Bodies
from world_server.proximity import near

SCENARIO = load_scenario(None, overrides=[("algorithm", "plume-map", "test"), ("topology", "all", "test")])
VIEW = robot_view(SCENARIO, 0)
BODY, TIMING = SCENARIO.body, SCENARIO.timing
KEPT = VIEW.repulsion.keep - GIVE
TOP = top_acceleration(BODY)
angle = st.floats(-3.2, 3.2)
speeds = st.tuples(st.floats(-0.8, 0.8), st.floats(-1.57, 1.57))
torque = st.sampled_from([-9.0, -0.4, 0.0, 0.4, 9.0])


@dataclass
class Yard:
    """Robots with sensors and guards and nothing else."""

    hands: list[tuple[float, float]]
    headings: list[float]
    view: RobotScenario = VIEW
    least: float = math.inf
    tick: int = 0
    held: set[int] = field(default_factory=set)

    def __post_init__(self) -> None:
        xs = [x - BODY.hand * math.cos(a) for (x, _), a in zip(self.hands, self.headings, strict=True)]
        ys = [y - BODY.hand * math.sin(a) for (_, y), a in zip(self.hands, self.headings, strict=True)]
        self.bodies = Bodies(BODY, TIMING, xs, ys, self.headings)
        self.guards = [Guard(self.view) for _ in xs]
        self.eyes = [Proximity(self.view) for _ in xs]

    def drive(self, wanted) -> None:
        """One tick; `wanted` gives the torques that robot i would like, from what it knows."""
        seen = near(self.bodies.robots, self.view.proximity)
        left, right = [0.0] * len(seen), [0.0] * len(seen)
        for i, r in enumerate(self.bodies.robots):
            if i in self.held:
                continue
            reading = Reading(i, self.tick, 0.05 * self.tick, r.x, r.y, r.theta, r.nu, r.omega, 0, 0, 0, near=seen[i])
            own, eyes = Own(reading, BODY), self.eyes[i]
            eyes.sense(reading)
            left[i], right[i] = self.guards[i].permit(*wanted(i, own, eyes), own, eyes.bodies)
        self.bodies.brake([i in self.held for i in range(len(seen))])
        self.bodies.step(left, right)
        self.tick += 1
        self.least = min([self.least, *(math.dist(a, b) for a, b in combinations(self.bodies.hands().tolist(), 2))])


def towards(goals, *, barrier=True):
    """Torques of a law that pulls robot i to its goal."""

    def wanted(i: int, own: Own, eyes: Proximity) -> tuple[float, float]:
        u = (-4 * (own.x - goals[i][0]) - 2 * own.vx, -4 * (own.y - goals[i][1]) - 2 * own.vy)
        if barrier:
            u = keep_clear(u, own, eyes.see(own, []), replace(VIEW.repulsion, d=1.5), TOP)
        return wheel_torques(*u, own, BODY)

    return wanted


# Cells of a grid of 0.8 m: who starts there starts at least so far from the others.
starts = st.lists(st.tuples(st.integers(-2, 2), st.integers(-2, 2)), min_size=2, max_size=8, unique=True).map(
    lambda cells: [(0.8 * x, 0.8 * y) for x, y in cells]
)
headings = st.lists(angle, min_size=8, max_size=8)
goals = st.lists(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), min_size=8, max_size=8)


@given(starts, headings, goals, st.booleans(), st.booleans())
@settings(max_examples=10, deadline=None)
def test_robots_that_go_where_they_like_or_all_to_one_place_stay_apart(hands, turned, places, together, barrier):
    yard = Yard(hands, turned[: len(hands)])
    law = towards([places[0]] * 8 if together else places, barrier=barrier)
    for _ in range(120):
        yard.drive(law)
    assert yard.least >= KEPT


@given(starts, headings, st.lists(st.tuples(torque, torque), min_size=8, max_size=24), st.integers(1, 12))
@settings(max_examples=10, deadline=None)
def test_whatever_the_wheels_are_asked_for(hands, turned, orders, every):
    yard = Yard(hands, turned[: len(hands)])
    for tick in range(120):
        yard.drive(lambda i, own, eyes, now=tick: orders[(now // every + 3 * i) % len(orders)])
    assert yard.least >= KEPT


hangs = st.lists(st.tuples(st.integers(0, 7), st.integers(5, 120), st.integers(1, 60)), min_size=1, max_size=4)


@given(starts, headings, goals, hangs)
@settings(max_examples=10, deadline=None)
def test_robots_that_hang_brake_and_come_back(hands, turned, places, times):
    yard = Yard(hands, turned[: len(hands)])
    for tick in range(120):
        yard.held = {i for i, first, length in times if first <= tick < first + length and i < len(hands)}
        yard.drive(towards(places, barrier=False))
    assert yard.least >= KEPT


@given(st.lists(st.tuples(speeds, angle), min_size=2, max_size=6), st.booleans())
@settings(max_examples=10, deadline=None)
def test_robots_that_meet_at_speed(moving, barrier):
    """On a circle, as near as they may be at their speeds, and all sent to its centre."""
    stops = Stops(BODY, TIMING.tick)
    radius = (0.65 + 2 * stops.longest) / (2 * math.sin(math.pi / len(moving)))
    around = [2 * math.pi * i / len(moving) for i in range(len(moving))]
    hands = [(radius * math.cos(p), radius * math.sin(p)) for p in around]
    yard = Yard(hands, [turned for _, turned in moving])
    for robot, ((nu, omega), _) in zip(yard.bodies.robots, moving, strict=True):
        robot.nu, robot.omega = nu, omega
    for _ in range(120):
        yard.drive(towards([(0.0, 0.0)] * len(moving), barrier=barrier))
    assert yard.least >= KEPT


@given(angle, angle, st.floats(0.42, 0.6))
@settings(max_examples=10, deadline=None)
def test_robots_that_start_too_near_part(one, other, apart):
    yard = Yard([(0.0, 0.0), (apart, 0.0)], [one, other])
    for _ in range(400):
        yard.drive(towards([(-3.0, 0.0), (3.0, 0.0)]))
    assert math.dist(*yard.bodies.hands()) > 3.0
    assert yard.least > apart - 0.01


def test_without_a_guard_they_collide():
    yard = Yard([(0.0, 0.0), (3.0, 0.0)], [0.0, 3.14], replace(VIEW, repulsion=replace(VIEW.repulsion, keep=0.0)))
    for _ in range(120):
        yard.drive(towards([(3.0, 0.0), (0.0, 0.0)], barrier=False))
    assert yard.least < 0.3


@given(speeds, angle)
def test_no_body_goes_further_than_the_bound_while_it_brakes(speed, turned):
    bodies = Bodies(BODY, Timing(), [0.0], [0.0], [turned])
    robot = bodies.robots[0]
    robot.nu, robot.omega = speed
    fast = math.hypot(robot.nu, BODY.hand * robot.omega)
    bodies.brake([True])
    for _ in range(40):
        bodies.step([0.0], [0.0])
    assert robot.nu == pytest.approx(0.0, abs=1e-12)
    assert robot.travelled <= Stops(BODY, 0.05).bound(fast)
    assert Stops(BODY, 0.05).bound(fast) <= 0.55


@given(speeds, torque, torque, st.sampled_from(["per-wheel", "proportional"]))
def test_the_way_that_is_looked_at_is_the_one_that_the_body_goes(speed, left, right, saturation):
    body = Body(saturation=saturation)
    bodies = Bodies(body, Timing(), [0.0], [0.0], [0.0])
    robot = bodies.robots[0]
    robot.nu, robot.omega = speed
    looked_at = way((left, right), *speed, body, 0.05, 5)
    for k, (x, y) in enumerate(looked_at):
        bodies.brake([k > 0])
        bodies.step([left], [right])
        assert math.hypot(robot.hand_x - body.hand - x, robot.hand_y - y) < 1e-3
    assert robot.nu == pytest.approx(0.0, abs=1e-9)


def test_who_is_alone_or_far_away_does_as_its_law_says():
    own = Own(Reading(0, 0, 0.0, 0.0, 0.0, 0.0, 0.8, 1.0, 0, 0, 0), BODY)
    for others in ((), ((3.0, 0.0),), ((0.0, -2.5),)):
        eyes = Proximity(VIEW)
        eyes.sense(Reading(0, 0, 0.0, 0.0, 0.0, 0.0, 0.8, 1.0, 0, 0, 0, near=others))
        assert Guard(VIEW).permit(9.0, -9.0, own, eyes.bodies) == (9.0, -9.0)


def test_the_range_that_is_asked_for_is_enough():
    assert range_needed(BODY, TIMING.tick, VIEW.repulsion.keep) < VIEW.proximity == 3.0


@given(st.lists(st.tuples(torque, torque), min_size=4, max_size=4), st.integers(5, 60), angle)
@settings(max_examples=20, deadline=None)
def test_nobody_is_faster_than_it_is_taken_for(orders, ticks, turned):
    bodies = Bodies(BODY, TIMING, [0.0, 1.5], [0.0, 0.5], [0.0, turned])
    eyes = Proximity(VIEW)
    for k in range(ticks):
        me = bodies.robots[0]
        seen = near(bodies.robots, 3.0)[0]
        # Its compass and odometry are wrong; it makes no difference.
        eyes.sense(Reading(0, k, 0.05 * k, 7.0 * k, -k, 2.0 * k, me.nu, me.omega, 0, 0, 0, near=seen))
        vx, vy = bodies.hand_velocities()[1]
        for body in eyes.bodies:
            assert math.hypot(vx, vy) <= body.fastest + 1e-9
            c, s = math.cos(me.theta), math.sin(me.theta)
            if body.fastest < fastest_hand(BODY):  # not one that was out of range just now
                true = (c * vx + s * vy, c * vy - s * vx)
                assert math.dist(true, (body.v_ahead, body.v_left)) < 0.06 + 0.04 * math.hypot(body.ahead, body.left)
        one, two = orders[(k // 10) % 2], orders[2 + (k // 7) % 2]
        bodies.step([one[0], two[0]], [one[1], two[1]])
    assert fastest_hand(BODY) >= max(body.fastest for body in eyes.bodies) if eyes.bodies else True


def test_in_range_the_eyes_count_and_beyond_it_what_was_told():
    own = Own(Reading(0, 0, 0.0, 10.0, 0.0, math.pi / 2, 0.0, 0.0, 0, 0, 0), BODY)  # hand at (10, 0.12), heading +y
    eyes = Proximity(VIEW)
    eyes.sense(Reading(0, 0, 0.0, 10.0, 0.0, math.pi / 2, 0.0, 0.0, 0, 0, 0, near=((1.0, 0.0), (0.0, 2.0))))
    told = [(10.0, 1.12, 0.1, 0.2), (12.0, 0.12, 0.0, 0.0), (14.0, 0.12, 0.3, 0.0)]
    placed = eyes.see(own, told)
    assert placed[0] == pytest.approx((10.0, 1.12, 0.1, 0.2))  # seen where it says that it is: believed how it moves
    assert placed[1][:2] == pytest.approx((8.0, 0.12))  # seen, told by nobody: at its worst
    assert placed[1][2] == pytest.approx(fastest_hand(BODY))
    assert placed[2:] == [told[2]]  # nobody is seen at (12, 0.12)
