"""Chapter 2: the consensus law (2.7), the spiral (2.8), (2.9), and the architectures that are made of them."""

from __future__ import annotations

from math import atan, atan2, cos, exp, hypot, log, pi, sin

import msgspec
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from deploy.memory_run import MemorySwarm
from protocol.messages import Reading, Shared
from protocol.scenario import RobotScenario, Scenario, robot_view
from protocol.scenario.laws import Spiral
from protocol.scenario.load import load_scenario
from protocol.scenario.sections import Body
from robot_agent.algorithms import ALGORITHMS
from robot_agent.control.consensus import ConsensusControl, consensus
from robot_agent.hand import Own
from robot_agent.interfaces import SEARCH, TRACE, Plan
from robot_agent.planning.centre import CentrePlanner
from robot_agent.planning.spiral import SpiralPlanner, spiral, steps

points = st.tuples(st.floats(-40, 40), st.floats(-40, 40))
P = Spiral()


def scenario(**values: object) -> Scenario:
    chosen = {name.replace("__", "."): value for name, value in values.items()}
    return load_scenario(None, overrides=[(k, v, "test") for k, v in chosen.items()], algorithms=ALGORITHMS)


def view(robot: int = 0, **values: object) -> RobotScenario:
    return robot_view(scenario(**values), robot)


def own_at(x: float, y: float, tick: int = 0, v=(0.0, 0.0)) -> Own:
    reading = Reading(0, tick, tick * 0.05, x, y, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0)
    own = Own(reading, msgspec.structs.replace(Body(), hand=1e-9))
    own.vx, own.vy = v
    return own


# --- (2.7)


@given(x=points, p=points, others=st.lists(st.tuples(st.floats(0, 2), points, points), max_size=4))
def test_consensus_law_is_the_printed_sum(x, p, others):
    expected = -0.35 * np.subtract(x, p)
    for a_ij, x_j, p_j in others:
        expected -= a_ij * (np.subtract(x, p) - np.subtract(x_j, p_j))
    offsets = [(a, (x_j[0] - p_j[0], x_j[1] - p_j[1])) for a, x_j, p_j in others]
    assert consensus((x[0] - p[0], x[1] - p[1]), offsets, 0.35) == pytest.approx(tuple(expected), abs=1e-9)


@pytest.mark.parametrize("topology", ["all", "ring", "line", "star"])
@pytest.mark.parametrize("robots", [3, 12])
def test_proposition_1_every_robot_comes_to_its_own_target(topology, robots):
    """x_i -> p_i, with p_j told by the neighbours themselves; the targets are far enough apart to stand on."""
    s = scenario(topology=topology, robots=robots, algorithm="pso-a")
    laws = [ConsensusControl(robot_view(s, i)) for i in range(robots)]
    angles = 2 * pi * np.arange(robots) / robots
    targets = 20.0 * np.column_stack([np.cos(angles), np.sin(angles)])
    xs, vs, dt = 1.1 * targets + (3.0, -2.0), np.zeros((robots, 2)), 0.05
    rows = [robot_view(s, i).row for i in range(robots)]
    for _ in range(round(40.0 / dt)):
        states = [
            Shared(i, 0, *xs[i], *vs[i], *([0.0] * 13), virtual=laws[i].virtual()) for i in range(robots)
        ]
        us = []
        for i in range(robots):
            fresh = [(a, states[j]) for j, a in rows[i]]
            placed = [(*xs[j], *vs[j]) for j in range(robots) if j != i]
            plan = Plan(TRACE, (float(targets[i, 0]), float(targets[i, 1])))
            us.append(laws[i].control(own_at(*xs[i], v=tuple(vs[i])), fresh, placed, plan, dt))
        vs += dt * np.array(us)
        xs += dt * vs
    assert np.hypot(*(xs - targets).T).max() < 0.05


def test_command_is_no_faster_than_the_table_says():
    law = ConsensusControl(view())
    u = law.control(own_at(0.0, 0.0), [], [], Plan(TRACE, (300.0, 400.0)), 0.05)
    assert hypot(*u) == pytest.approx(5.0 * 0.8)
    assert u[1] / u[0] == pytest.approx(4.0 / 3.0)


def test_neighbours_without_a_target_are_left_out_and_the_search_tells_none():
    law = ConsensusControl(view())
    assert law.virtual() == ()
    plan = Plan(TRACE, (1.0, 0.0))
    silent = Shared(1, 0, 9.0, 9.0, *([0.0] * 15))
    assert law.control(own_at(0.0, 0.0), [(1.0, silent)], [], plan, 0.05) == law.control(
        own_at(0.0, 0.0), [], [], plan, 0.05
    )
    assert law.virtual() == (1.0, 0.0)
    law.control(own_at(0.0, 0.0), [], [], Plan(SEARCH, (0.0, 0.0), v_c=(0.0, 0.8)), 0.05)
    assert law.virtual() == ()


# --- (2.8), (2.9)


@given(start=points, h=points)
def test_spiral_begins_a_beside_the_robot_and_ends_in_the_decided_position(start, h):
    """Exactly a, since (2.8) takes a off before it turns; 0.1 m in the thesis."""
    r = hypot(start[0] - h[0], start[1] - h[1])
    assume(r > 2 * P.a)
    first = spiral(start, h, 0, P)
    assert hypot(first[0] - start[0], first[1] - start[1]) == pytest.approx(P.a, rel=1e-6)
    assert spiral(start, h, steps(r, P), P) == h
    before = spiral(start, h, steps(r, P) - 1, P)
    assert before != h
    assert hypot(before[0] - h[0], before[1] - h[1]) < 2 * P.a


@given(start=points, h=points, k=st.integers(0, 150))
def test_spiral_winds_inwards_as_a_logarithmic_one(start, h, k):
    """The distance from its own centre, h - R(theta_1)(a, 0), falls by e^(-0.1 b) a step and the angle by 0.1 rad."""
    r = hypot(start[0] - h[0], start[1] - h[1])
    assume(r > 2 * P.a)
    assume(k + 1 < steps(r, P))
    theta_max = log(r / P.a) / P.b
    theta_1 = atan2(start[1] - h[1], start[0] - h[0]) - theta_max
    pole = (h[0] - P.a * cos(theta_1), h[1] - P.a * sin(theta_1))
    here, there = ((p[0] - pole[0], p[1] - pole[1]) for p in (spiral(start, h, k, P), spiral(start, h, k + 1, P)))
    assert hypot(*there) / hypot(*here) == pytest.approx(exp(-0.1 * P.b), rel=1e-6)
    turn = atan2(here[0] * there[1] - here[1] * there[0], here[0] * there[0] + here[1] * there[1])
    assert turn == pytest.approx(-0.1, abs=1e-6)


def printed_angle(x: float, y: float) -> float:
    """theta_11 and theta_12 by the printed quadrant rules, with atan of a quotient."""
    angle = atan(y / x)
    if x > 0 and y > 0:
        return angle
    if x > 0 and y < 0:
        return 2 * pi + angle
    return pi + angle


@given(start=points, h=points, k=st.integers(0, 150))
@settings(max_examples=200)
def test_quadrant_rules_of_the_thesis_give_the_same_spiral_inside_the_quadrants(start, h, k):
    x, y = start[0] - h[0], start[1] - h[1]
    assume(abs(x) > 1e-6)
    assume(abs(y) > 1e-6)
    r = hypot(x, y)
    assume(r > 2 * P.a)
    theta_max = log(r / P.a) / P.b
    theta = theta_max - 0.1 * k
    assume(theta > 0.0)
    theta_1 = printed_angle(x, y) - printed_angle(r * cos(theta_max), r * sin(theta_max))
    size = P.a * exp(P.b * theta)
    s = np.array([size * cos(theta) - P.a, size * sin(theta)])
    turn = np.array([[cos(theta_1), -sin(theta_1)], [sin(theta_1), cos(theta_1)]])
    assert spiral(start, h, k, P) == pytest.approx(tuple(turn @ s + h), abs=1e-6)


def test_quadrant_rules_of_the_thesis_are_wrong_on_the_axis_where_ours_is_right():
    """p_iy = h_iy with p_ix > h_ix falls under "otherwise": pi instead of 0, so the spiral would begin on the far side."""
    assert printed_angle(5.0, 0.0) == pytest.approx(pi)
    first = spiral((5.0, 0.0), (0.0, 0.0), 0, P)
    assert hypot(first[0] - 5.0, first[1]) == pytest.approx(P.a)
    with pytest.raises(ZeroDivisionError):
        printed_angle(0.0, 5.0)
    first = spiral((0.0, 5.0), (0.0, 0.0), 0, P)
    assert hypot(first[0], first[1] - 5.0) == pytest.approx(P.a)


@given(h=points, angle=st.floats(0, 6.28), part=st.floats(0, 1), k=st.integers(0, 50))
def test_nearer_than_a_there_is_no_spiral_but_the_decided_position(h, angle, part, k):
    start = (h[0] + 0.999 * part * P.a * cos(angle), h[1] + 0.999 * part * P.a * sin(angle))
    assert spiral(start, h, k, P) == h


def test_planner_steps_along_one_spiral_until_the_decision_changes():
    planner = SpiralPlanner(view())
    start, h = (50.0, 10.0), (30.0, 0.0)
    plan = planner.plan(own_at(*start, tick=1000), h, lost=False)
    for tick in range(1001, 1100):
        # The robot is elsewhere by now, but the spiral is still that of where it was at k.
        own = own_at(48.0, 12.0, tick=tick)
        plan = planner.plan(own, h, lost=False) if tick % 20 == 0 else planner.follow(own, plan)
        assert plan.target == pytest.approx(spiral(start, h, (tick - 1000) // 20, P), abs=1e-6)
        assert plan.centre == h
    new = planner.plan(own_at(47.0, 12.0, tick=1100), (20.0, 0.0), lost=False)
    assert new.target == pytest.approx(spiral((47.0, 12.0), (20.0, 0.0), 0, P), abs=1e-6)


def test_plan_without_a_spiral_is_the_decision():
    plan = CentrePlanner(view()).plan(own_at(50.0, 0.0), (30.0, 1.0), lost=False)
    assert plan.target == (30.0, 1.0)


# --- the whole


@pytest.mark.parametrize("algorithm", ["pso-a", "pso-s-c"])
def test_group_comes_together_about_the_best_place_that_it_knows(algorithm):
    """Without new odour the decision settles on x_g, and so do the robots, as far as they keep clear of each other."""
    s = scenario(
        algorithm=algorithm, topology="ring", robots=3, max_time=90.0, start__x=60.0, start__y=-6.0,
        plume__warm_up=120.0, consensus__sampling=5.0, decision__threshold=600.0,
    )  # fmt: skip
    swarm = MemorySwarm(s)
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
    group = swarm.robots[0].session.agent._group
    hands = swarm.session.world.bodies.hands()
    assert group.started
    assert np.hypot(*(hands - (group.best_x, group.best_y)).T).max() < 12.0
    assert swarm.session.world.verdict.min_pair_distance > 0.4
