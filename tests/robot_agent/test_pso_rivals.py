"""Particle swarms as decisions and direct controls: formulas, charge, wind utilisation, whole runs on sparse graphs."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, degrees, hypot, pi, radians, sin

import msgspec
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from deploy.memory_run import MemorySwarm, run_in_memory
from protocol.messages import Reading, Shared
from protocol.scenario import RobotScenario, robot_view
from protocol.scenario.load import load_scenario
from protocol.scenario.sections import Arena, Body
from robot_agent import particle
from robot_agent.algorithms import ALGORITHMS
from robot_agent.decision import pso as decisions
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import TRACE, Around
from robot_agent.neighbours import Neighbours
from robot_agent.particle import Coefficients, Sampling
from robot_agent.planning import discrete
from robot_agent.planning.wind_use import WindPlanner, avoid_downwind, cosine, wui_45, wuii

points = st.tuples(st.floats(-50, 50), st.floats(-50, 50))
positive = st.floats(0.01, 4.0)
RIVALS = ["pso", "cpso", "pso-a", "cpso-a", "pso-s-c", "cpso-s-c", "wui-45", "wuii"]


@dataclass(frozen=True)
class Constants:
    inertia: float = 0.7
    c1: float = 1.5
    c2: float = 2.5
    draws: str = "scalar"


def view(robot: int = 0, **values: object) -> RobotScenario:
    chosen = {name.replace("__", "."): value for name, value in values.items()}
    return robot_view(load_scenario(None, overrides=[(k, v, "test") for k, v in chosen.items()]), robot)


def own_at(x: float, y: float, t: float = 0.0, v=(0.0, 0.0), wind=(1.0, 0.0)) -> Own:
    tick = round(t / 0.05)
    own = Own(Reading(0, tick, t, x, y, 0.0, 0.0, 0.0, *wind, 0.0), msgspec.structs.replace(Body(), hand=1e-9))
    own.vx, own.vy = v
    return own


def group_with(best=(0.0, 0.0), mine=None) -> Group:
    group = Group()
    if mine is not None:
        group.detect(1.0, 700.0, *mine)
    other = Group()
    other.detect(1.0, 900.0, *best)
    group.merge(
        Shared(1, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, other.first_detected_at, other.detected_at, other.best, other.best_x,
               other.best_y, -1, 0, 0.0, 0.0, 0.0, 0.0, best_at=other.best_at)
    )  # fmt: skip
    return group


# --- the formulas


@given(x=points, v=points, x_l=points, x_g=points, a=positive, b=positive, omega=st.floats(0, 0.99))
def test_pull_to_the_centre_is_the_pull_to_both_best_places(x, v, x_l, x_g, a, b, omega):
    """(2.4) in (2.5) gives (2.3) again, inside (2.2)."""
    alpha = Coefficients((a, a), (b, b))
    p = particle.centre(x_l, x_g, alpha)
    expected = [omega * v[n] + a * (x_l[n] - x[n]) + b * (x_g[n] - x[n]) for n in (0, 1)]
    assert particle.next_velocity(v, x, p, alpha, omega, 1e9) == pytest.approx(expected, rel=1e-9, abs=1e-9)


@given(x_l=points, x_g=points, a=positive, b=positive)
def test_centre_lies_between_the_two_best_places(x_l, x_g, a, b):
    p = particle.centre(x_l, x_g, Coefficients((a, a), (b, b)))
    ways = hypot(p[0] - x_l[0], p[1] - x_l[1]) + hypot(p[0] - x_g[0], p[1] - x_g[1])
    assert ways == pytest.approx(hypot(x_l[0] - x_g[0], x_l[1] - x_g[1]), abs=1e-6)


@given(v=points, x=points, p=points, a=positive, longest=positive)
def test_no_way_is_longer_than_what_can_be_driven(v, x, p, a, longest):
    alpha = Coefficients((a, a), (a, a))
    way = particle.next_velocity(v, x, p, alpha, 0.9, longest)
    assert hypot(*way) <= longest * (1 + 1e-12)


@pytest.mark.parametrize("draws", ["scalar", "per-axis"])
def test_coefficients_are_uniform_and_belong_to_robot_and_tick(draws):
    c = Constants(draws=draws)
    drawn = [particle.coefficients(7, robot, tick, c) for robot in range(10) for tick in range(200)]
    ax, ay = np.array([d.alpha1 for d in drawn]).T
    b = np.array([d.alpha2 for d in drawn])
    assert (ax == ay).all() == (draws == "scalar")
    assert b.min() > 0.0
    for values, top in ((ax, c.c1), (b[:, 0], c.c2)):
        assert values.max() <= top
        # Mean and variance of U(0, top), within 5 standard errors of 2000 draws.
        assert values.mean() == pytest.approx(top / 2, abs=5 * top / np.sqrt(12 * 2000))
        assert values.var() == pytest.approx(top**2 / 12, rel=0.1)
    assert particle.coefficients(7, 3, 40, c) == particle.coefficients(7, 3, 40, c)
    assert len({d.alpha1 for d in drawn}) == len(drawn)


@given(x=points, others=st.lists(points, max_size=4), charge=positive, core=positive, more=st.floats(0, 20))
def test_charge_pushes_as_blackwell_prints_it(x, others, charge, core, more):
    reach = core + more
    expected = np.zeros(2)
    for other in others:
        gap = np.subtract(x, other)
        r = np.hypot(*gap)
        if r == 0.0:
            continue
        if r < core:
            expected += charge**2 * gap / (core**2 * r)
        elif r <= reach:
            expected += charge**2 * gap / r**3
    assert particle.coulomb(x, others, charge, core, reach) == pytest.approx(tuple(expected), rel=1e-6, abs=1e-9)


@given(x=points, other=points)
def test_two_charged_robots_push_each_other_apart_alike(x, other):
    assume(x != other)
    push = particle.coulomb(x, [other], 2.0, 1.0, 1e3)
    back = particle.coulomb(other, [x], 2.0, 1.0, 1e3)
    assert push == pytest.approx((-back[0], -back[1]))
    assert push[0] * (x[0] - other[0]) + push[1] * (x[1] - other[1]) > 0.0


@pytest.mark.parametrize("n", range(1, 9))
def test_half_of_the_robots_rounded_down_is_charged(n):
    assert sum(particle.is_charged(i) for i in range(n)) == n // 2


# --- when


@given(period=st.sampled_from([1.0, 10.0, 20.0, 30.0, 2.5]), start=st.floats(0, 100))
def test_a_new_k_begins_every_period_at_the_nearest_look(period, start):
    sampling = Sampling(period, 1.0)
    assert sampling.due(start)
    looks = [float(int(start) + n) for n in range(1, 400)]
    due = [t for t in looks if sampling.due(t)]
    assert due[0] == pytest.approx(start + period, abs=0.5 + 1e-9)
    assert np.diff(due).mean() == pytest.approx(period, abs=0.51)
    assert abs(np.diff(due) - period).max() <= 0.5


# --- decision and direct control together


def test_decision_and_control_together_are_the_printed_swarm():
    """The way to the next place is omega v + alpha_1 (x_l - x) + alpha_2 (x_g - x), both parts seeing the same alpha."""
    s = view(pso__inertia=0.5, pso__c1=0.2, pso__c2=0.3, pso__draws="scalar")
    decision, planner = decisions.pso(s), discrete.pso(s)
    own, group = own_at(50.0, 0.0, t=45.0, v=(0.1, 0.2)), group_with(best=(40.0, 5.0), mine=(52.0, 3.0))
    decision.begin(own)
    decision.decide(own, group, True, Around([], []))
    plan = planner.plan(own, decision.h, lost=False)
    alpha = particle.coefficients(s.seed, s.robot, own.tick, s.pso)
    a, b = alpha.alpha1[0], alpha.alpha2[0]
    way = (0.5 * 30 * 0.1 + a * 2.0 + b * -10.0, 0.5 * 30 * 0.2 + a * 3.0 + b * 5.0)
    assert plan.target == pytest.approx((50.0 + way[0], 0.0 + way[1]))
    assert plan.v_c == pytest.approx((way[0] / 30.0, way[1] / 30.0))


def test_velocity_and_decision_are_held_until_the_next_k():
    s = view(pso__sampling=10.0)
    decision, planner = decisions.pso(s), discrete.pso(s)
    group = group_with(best=(40.0, 5.0), mine=(52.0, 3.0))
    seen = []
    for t in range(45, 66):
        own = own_at(50.0 + 0.1 * t, 0.0, t=float(t))
        decision.decide(own, group, False, Around([], []))
        seen.append((decision.h, planner.plan(own, decision.h, lost=False).v_c))
    changes = [k for k in range(1, 21) if seen[k] != seen[k - 1]]
    assert changes == [10, 20]
    assert seen[10][0] != seen[0][0]
    assert seen[10][1] != seen[0][1]


def test_robot_that_has_not_smelt_anything_is_drawn_to_the_groups_best_alone():
    s = view(pso__draws="scalar")
    decision = decisions.pso(s)
    own = own_at(50.0, 0.0, t=45.0)
    decision.decide(own, group_with(best=(40.0, 10.0)), False, Around([], []))
    alpha = particle.coefficients(s.seed, s.robot, own.tick, s.pso)
    part = alpha.alpha2[0] / alpha.total[0]
    assert decision.h == pytest.approx((50.0 - 10.0 * part, 10.0 * part))


def test_charged_robot_is_pushed_by_charged_robots_only_and_a_neutral_one_by_nobody():
    group = group_with(best=(40.0, 5.0), mine=(52.0, 3.0))
    own = own_at(50.0, 0.0, t=45.0)
    places = [(53.0, 0.0, 0.0, 0.0), (47.0, 0.0, 0.0, 0.0)]

    def decided(robot: int, numbers: list[int]) -> tuple[float, float]:
        decision = decisions.cpso(view(robot, robots=5, topology="line", cpso__reach=10.0, cpso__charge=3.0))
        decision.decide(own, group, False, Around([], places[: len(numbers)], numbers))
        return decision.h

    alone = decided(1, [])
    assert decided(1, [2]) == alone  # robot 2 is neutral
    pushed = decided(1, [3])
    assert pushed[0] < alone[0]
    assert decided(1, [3, 0]) == pushed
    assert decided(2, [3]) == decided(2, [])


def test_push_stands_outside_of_the_constriction():
    """[Blackwell 2003]: v(k+1) = chi (v + phi_1 .. + phi_2 ..) + a: the push enters the way with weight 1."""
    s = view(1, robots=5, cpso__reach=10.0, cpso__charge=1.5)
    own, group = own_at(50.0, 0.0, t=45.0), group_with(best=(51.0, 0.5), mine=(50.5, 0.5))
    ways = []
    for places, numbers in (([], []), ([(53.0, 0.0, 0.0, 0.0)], [3])):
        decision, planner = decisions.cpso(s), discrete.cpso(s)
        decision.decide(own, group, False, Around([], places, numbers))
        ways.append(planner.plan(own, decision.h, lost=False).target)
    assert ways[1][0] - ways[0][0] == pytest.approx(-(1.5**2) / 3.0**2)
    assert ways[1][1] == pytest.approx(ways[0][1])


@given(x=st.tuples(st.floats(0, 100), st.floats(-50, 50)), p=points, v=st.tuples(st.floats(-0.8, 0.8), st.floats(-0.8, 0.8)))
def test_plans_end_inside_the_arena(x, p, v):
    s = view()
    planner = discrete.pso(s)
    plan = planner.plan(own_at(*x, t=45.0, v=v), p, lost=False)
    assert 0.0 <= plan.target[0] <= 100.0
    assert -50.0 <= plan.target[1] <= 50.0
    assert hypot(*plan.v_c) <= 0.8 * (1 + 1e-9)


def test_velocity_outwards_ends_before_the_edge():
    arena, v, dt = Arena(), (0.8, -0.8), 0.05
    own = own_at(97.0, -47.0)
    for _ in range(2000):
        v_x, v_y = discrete.inside(v, own, arena, 0.45)
        own.x, own.y = own.x + dt * v_x, own.y + dt * v_y
    assert 99.9 < own.x <= 100.0 + 0.8 * dt
    assert -50.0 - 0.8 * dt <= own.y < -49.9


# --- wind utilisation


def planned(planner: WindPlanner, theta: float) -> tuple[float, float]:
    """What the planner makes of a way of 5 m at the angle theta to the wind."""
    wind_angle = 0.4
    own = own_at(50.0, 0.0, wind=(1.2 * cos(wind_angle), 1.2 * sin(wind_angle)))
    return planner.shape((5.0 * cos(wind_angle + theta), 5.0 * sin(wind_angle + theta)), own)


@given(theta=st.floats(-pi, pi))
def test_wuii_scales_a_way_by_its_angle_to_the_wind(theta):
    way = planned(wuii(view()), theta)
    assert hypot(*way) == pytest.approx(5.0 * (1 - cos(theta)) / 2, abs=1e-9)


@given(theta=st.floats(-180, 180))
def test_wui_45_stops_within_45_degrees_of_downwind_only(theta):
    assume(abs(abs(theta) - 45.0) > 1e-3)
    way = planned(wui_45(view(wui__forbidden="stop")), radians(theta))
    assert hypot(*way) == pytest.approx(0.0 if abs(theta) < 45.0 else 5.0)


@given(theta=st.floats(-180, 180), angle=st.floats(5, 170))
def test_a_forbidden_way_can_turn_to_the_nearer_edge_of_the_cone(theta, angle):
    assume(abs(abs(theta) - angle) > 1e-3)
    wind, v = (2.0, 0.0), (3.0 * cos(radians(theta)), 3.0 * sin(radians(theta)))
    turned = avoid_downwind(v, wind, radians(angle), turns=True)
    assert hypot(*turned) == pytest.approx(3.0)
    new = degrees(np.arctan2(turned[1], turned[0]))
    if abs(theta) > angle:
        assert turned == v
    elif abs(theta) > 1e-6:
        assert new == pytest.approx(angle if theta > 0 else -angle, abs=1e-6)


def test_without_wind_or_way_nothing_breaks():
    assert cosine((0.0, 0.0), (1.0, 0.0)) == 1.0
    assert cosine((1.0, 0.0), (0.0, 0.0)) == 1.0
    assert avoid_downwind((0.0, 0.0), (1.0, 0.0), 0.8, turns=True) == (0.0, 0.0)
    assert avoid_downwind((1.0, 0.0), (0.0, 0.0), 0.8, turns=False) == (1.0, 0.0)


# --- who is who


def test_places_come_with_the_numbers_of_their_robots_relayed_ones_too():
    near = Neighbours(view(0, robots=5, topology="line"))
    relayed = ((2, 5, 20.0, 0.0, 0.0, 0.0), (3, 4, 30.0, 0.0, 0.0, 0.0))
    state = Shared(1, 5, 10.0, 0.0, 0.0, 0.0, *([0.0] * 13), relayed=relayed)
    near.hear(5, [state])
    others = near.others(5)
    assert {j: round(x) for j, (x, _, _, _) in zip(near.numbers, others, strict=True)} == {1: 10, 2: 20, 3: 30}
    near.hear(500, [])
    assert near.others(500) == []
    assert near.numbers == []


# --- whole runs


def near_the_plume(**values: object):
    chosen: dict[str, object] = {"start.x": 60.0, "start.y": -6.0, "plume.warm_up": 120.0, "max_time": 40.0}
    chosen |= {name.replace("__", "."): value for name, value in values.items()}
    return load_scenario(None, overrides=[(k, v, "test") for k, v in chosen.items()], algorithms=ALGORITHMS)


@pytest.mark.parametrize("algorithm", RIVALS)
def test_rivals_keep_apart_and_in_the_arena_on_a_line(algorithm):
    scenario = near_the_plume(algorithm=algorithm, topology="line", pso__sampling=10.0, wui__sampling=10.0)
    swarm = MemorySwarm(scenario)
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
        if swarm.session.world.tick % 20 == 0:
            hands = swarm.session.world.bodies.hands()
            assert (hands >= (-0.5, -50.5)).all()
            assert (hands <= (100.5, 50.5)).all()
    assert all(robot.session.agent.estimate is not None for robot in swarm.robots.values())
    assert swarm.session.world.verdict.min_pair_distance > 0.4


@pytest.mark.parametrize("algorithm", ["cpso", "pso-s-c"])
def test_swarm_goes_on_when_one_of_a_ring_dies(algorithm):
    """The others decide anew, on what they know, and are on their way."""
    swarm = MemorySwarm(near_the_plume(algorithm=algorithm, topology="ring", pso__sampling=5.0, consensus__sampling=5.0))
    swarm.start()
    while swarm.session.world.t < 25.0:
        swarm.tick()
    swarm.kill(2)
    decided = {i: set() for i in (0, 1, 3, 4)}
    while not swarm.session.over:
        for i, seen in decided.items():
            seen.add(swarm.robots[i].session.agent.estimate)
        swarm.tick()
    assert swarm.session.ended == "time out"
    assert all(len(seen) >= 3 for seen in decided.values())


@pytest.mark.parametrize("algorithm", ["wuii", "cpso-s-c"])
def test_runs_repeat_bit_for_bit_also_through_the_codec(algorithm):
    scenario = near_the_plume(algorithm=algorithm, topology="ring", max_time=8.0)
    assert run_in_memory(scenario).digest == run_in_memory(scenario, wire=True).digest


def test_plan_of_a_swarm_traces():
    s = view()
    assert discrete.pso(s).plan(own_at(50.0, 0.0), (40.0, 0.0), lost=False).mode == TRACE
