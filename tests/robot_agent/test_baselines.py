"""The baselines without a decision: they follow the wind, cross it, or wander, and say nothing about the source."""

import math
from itertools import combinations
from types import SimpleNamespace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deploy.memory_run import MemorySwarm, run_in_memory
from protocol.messages import Reading
from protocol.scenario import robot_view
from protocol.scenario.load import load_scenario
from robot_agent.decision.cast import CastDecision, cast
from robot_agent.decision.surge import SurgeDecision, inside, outside
from robot_agent.decision.walk import WalkDecision
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import Around
from robot_agent.planning.head import HeadPlanner

BASELINES = ["surge", "surge-cast", "random-walk"]


def scenario(**values):
    chosen = {"start.x": 60.0, "start.y": -6.0, "plume.warm_up": 120.0, "max_time": 8.0}
    chosen |= {name.replace("__", "."): value for name, value in values.items()}
    return load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])


def own_at(x, y, t=0.0, wind=(1.0, 0.0)):
    body = scenario().body
    return Own(Reading(0, round(20 * t), t, x - body.hand, y, 0.0, 0.0, 0.0, *wind, 0.0), body)


def heading(decision, own, notes=()):
    """Unit vector from the robot to where the decision sends it."""
    fresh = [(1.0, SimpleNamespace(notes=notes))] if notes else []
    decision.decide(own, Group(), False, Around(fresh, []))
    dx, dy = decision.h[0] - own.x, decision.h[1] - own.y
    return dx / math.hypot(dx, dy), dy / math.hypot(dx, dy)


# Surge


@settings(max_examples=40)
@given(angle=st.floats(-3.1, 3.1))
def test_surge_heads_against_the_wind_wherever_it_blows(angle):
    wind = (0.7 * math.cos(angle), 0.7 * math.sin(angle))
    decision = SurgeDecision(robot_view(scenario(), 0))
    assert heading(decision, own_at(50.0, 0.0, wind=wind)) == pytest.approx((-math.cos(angle), -math.sin(angle)))


def test_surge_turns_near_the_edge_and_comes_back_beside_its_way():
    s = scenario()
    decision = SurgeDecision(robot_view(s, 0))
    x, y, lines = 50.0, 0.0, []
    for t in range(1, 601):
        leg = decision._leg
        u, v = heading(decision, own_at(x, y, float(t)))
        if decision._leg != leg and decision._leg % 2 == 0:
            lines.append(y)
        x, y = x + 0.8 * u, y + 0.8 * v
        assert 0.0 <= x <= 100.0
        assert -50.0 <= y <= 50.0
    assert len(lines) >= 4
    assert lines[:4] == pytest.approx([2.0, -2.0, 4.0, -4.0], abs=0.5)  # shift, to this side and that


def test_surge_takes_up_the_leg_that_a_neighbour_speaks_of():
    decision = SurgeDecision(robot_view(scenario(), 0))
    assert heading(decision, own_at(50.0, 0.0)) == pytest.approx((-1.0, 0.0))
    assert heading(decision, own_at(50.0, 0.0), notes=(1.0,))[0] > 0.9
    assert decision.notes(own_at(50.0, 0.0)) == (1.0,)


def test_surge_in_calm_air_keeps_the_last_wind():
    decision = SurgeDecision(robot_view(scenario(), 0))
    heading(decision, own_at(50.0, 0.0, wind=(0.0, 1.0)))
    assert heading(decision, own_at(50.0, 0.0, wind=(0.0, 0.0))) == pytest.approx((0.0, -1.0))


# Surge-cast


@settings(max_examples=40)
@given(reach=st.floats(0.5, 20), retreat=st.floats(0, 3), way=st.floats(0, 500), step=st.floats(1e-3, 1.0))
def test_casting_is_one_unbroken_way_across_the_wind(reach, retreat, way, step):
    here, there = cast(way, reach, retreat), cast(way + step, reach, retreat)
    assert abs(there[0] - here[0]) <= step + 1e-9
    assert abs(there[1] - here[1]) <= retreat * math.ceil(step / reach + 1) + 1e-9


@settings(max_examples=40)
@given(reach=st.floats(0.5, 20), n=st.integers(1, 12))
def test_every_leg_of_casting_reaches_further_to_the_other_side(reach, n):
    end = cast(n * n * reach * (1 - 1e-12), reach, 1.0)
    assert end[0] == pytest.approx((1 if n % 2 else -1) * n * reach, rel=1e-6)
    assert end[1] == n - 1


def test_surge_cast_goes_upwind_while_it_smells_and_across_when_it_does_not():
    s = scenario()
    decision = CastDecision(robot_view(s, 0))
    decision.detect(own_at(50.0, 0.0, 10.0))
    assert heading(decision, own_at(49.0, 0.0, 11.0)) == pytest.approx((-1.0, 0.0))
    sides = []
    for t in range(16, 120):
        decision.decide(own_at(50.0, 0.0, float(t)), Group(), False, Around([], []))
        sides.append(decision.h[1])
    assert max(sides) > s.surge.cast
    assert min(sides) < -s.surge.cast


def test_surge_cast_takes_up_the_latest_detection_that_it_hears_of():
    decision = CastDecision(robot_view(scenario(), 0))
    decision.detect(own_at(50.0, 0.0, 10.0))
    own = own_at(70.0, 20.0, 40.0)
    decision.decide(own, Group(), False, Around([(1.0, SimpleNamespace(notes=(39.5, 69.0, 19.0)))], []))
    assert decision.notes(own) == (39.5, 69.0, 19.0)
    assert decision.h == pytest.approx((60.0, 20.0))  # it surges


# The random walk


@settings(max_examples=40)
@given(x=st.floats(-20, 120), y=st.floats(-70, 70), seed=st.integers(0, 1000))
def test_legs_of_the_random_walk_end_in_the_arena(x, y, seed):
    s = scenario(seed=seed)
    decision = WalkDecision(robot_view(s, 0))
    decision.decide(own_at(x, y), Group(), False, Around([], []))
    assert outside(decision.h, robot_view(s, 0), s.walk.margin) == 0.0


def test_robots_of_a_random_walk_draw_different_legs_and_the_same_ones_in_every_run():
    s = scenario()

    def first(robot):
        decision = WalkDecision(robot_view(s, robot))
        decision.decide(own_at(50.0, 0.0), Group(), False, Around([], []))
        return decision.h

    assert len({first(i) for i in range(5)}) == 5
    assert [first(i) for i in range(5)] == [first(i) for i in range(5)]


# What they have in common


def test_inside_of_an_arena_that_is_smaller_than_its_margins_is_its_middle():
    view = robot_view(scenario(), 0)
    assert inside((3.0, 4.0), view, 80.0) == (50.0, 0.0)
    assert inside((3.0, 4.0), view, 3.0) == (3.0, 4.0)


def test_the_plan_is_full_speed_to_the_place_and_slower_at_it():
    planner = HeadPlanner(0.8)
    assert planner.plan(own_at(0.0, 0.0), (10.0, 0.0), False).v_c == pytest.approx((0.8, 0.0))
    assert planner.plan(own_at(0.0, 0.0), (0.3, 0.0), False).v_c == pytest.approx((0.3, 0.0))
    assert planner.plan(own_at(0.0, 0.0), (0.0, 0.0), True).v_c == pytest.approx((0.0, 0.0))


@pytest.mark.parametrize("algorithm", BASELINES)
def test_who_decides_nothing_has_no_estimate(algorithm):
    swarm = MemorySwarm(scenario(algorithm=algorithm, topology="ring"))
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
    assert swarm.session.world.first_detection is not None
    for robot in swarm.robots.values():
        assert robot.session.agent._begun
        assert robot.session.agent.estimate is None
        assert not robot.session.agent.belief((), 0, 0).has_estimate


def test_the_outcome_of_who_decides_nothing_has_no_estimate_error():
    assert run_in_memory(scenario(algorithm="surge", max_time=4.0)).estimate_error == (None,) * 5


@pytest.mark.parametrize(("algorithm", "topology"), [("surge", "line"), ("surge-cast", "ring")])
def test_a_surge_finds_a_source_that_is_near_on_sparse_graphs(algorithm, topology):
    outcome = run_in_memory(scenario(algorithm=algorithm, topology=topology, source__x=35.0, max_time=400.0))
    assert outcome.found
    assert outcome.min_pair_distance > 0.4


@pytest.mark.parametrize("algorithm", BASELINES)
def test_a_baseline_goes_on_when_a_robot_is_killed(algorithm):
    swarm = MemorySwarm(scenario(algorithm=algorithm, topology="line", max_time=20.0), wire=True)
    living = [0, 1, 3, 4]
    nearest_pair = math.inf
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
        hands = swarm.session.world.bodies.hands()[living]
        nearest_pair = min(nearest_pair, *(math.dist(a, b) for a, b in combinations(hands, 2)))
        if swarm.session.world.tick == 200:
            swarm.kill(2)
            before = swarm.session.world.bodies.travelled[living]
    assert nearest_pair > 0.4
    assert (swarm.session.world.bodies.travelled[living] - before).min() > 2.0
