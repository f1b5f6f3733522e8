"""The control laws: equilibria, oracles, and what the group does under them as double integrators (1.7)."""

import math

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol.messages import Reading, Shared
from protocol.scenario import Scenario, robot_view
from protocol.scenario.laws import Repulsion
from protocol.scenario.load import load_scenario
from robot_agent.algorithms import ALGORITHMS
from robot_agent.control.repulsion import gradient_force
from robot_agent.hand import Own
from robot_agent.interfaces import LOST, TRACE, Plan

points = st.tuples(st.floats(-8, 8), st.floats(-8, 8))


def potential(x: float, y: float, others, p: Repulsion) -> float:
    """U of (3.36) as a function of one robot's place: each pair is counted twice."""
    total = 0.0
    for ox, oy in others:
        r = (x - ox) ** 2 + (y - oy) ** 2
        total += math.log(p.kappa + r) + (p.kappa + p.d**2) / (p.kappa + r)
    return total


@given(here=points, others=st.lists(points, min_size=1, max_size=4))
def test_repulsion_is_the_gradient_of_the_potential(here, others):
    p, h = Repulsion(), 1e-5
    x, y = here
    slope_x = (potential(x + h, y, others, p) - potential(x - h, y, others, p)) / (2 * h)
    slope_y = (potential(x, y + h, others, p) - potential(x, y - h, others, p)) / (2 * h)
    force = gradient_force(x, y, [(ox, oy, 0.0, 0.0) for ox, oy in others], p, reach=1e9)
    assert force == pytest.approx((-slope_x, -slope_y), rel=1e-4, abs=1e-5)


def test_repulsion_rests_at_distance_d():
    p = Repulsion()
    assert gradient_force(0.0, 0.0, [(p.d, 0.0, 0.0, 0.0)], p, reach=100.0) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert gradient_force(0.0, 0.0, [(p.d - 1, 0.0, 0.0, 0.0)], p, reach=100.0)[0] < 0
    assert gradient_force(0.0, 0.0, [(p.d + 1, 0.0, 0.0, 0.0)], p, reach=100.0)[0] > 0


class Group:
    """Double integrators under one law, every robot with what it hears from its neighbours."""

    def __init__(self, scenario: Scenario, xs, vs):
        self.scenario = scenario
        self.views = [robot_view(scenario, i) for i in range(scenario.robots)]
        law = ALGORITHMS[scenario.algorithm].controller
        self.laws = [law(view) for view in self.views]
        self.xs, self.vs = np.array(xs, float), np.array(vs, float)
        self.t = 0.0

    def owns(self) -> list[Own]:
        body = msgspec.structs.replace(self.scenario.body, hand=1e-9)
        result = []
        for i, (x, v) in enumerate(zip(self.xs, self.vs, strict=True)):
            own = Own(Reading(i, 0, self.t, x[0], x[1], 0.0, 0.0, 0.0, 1.0, 0.0, 0.0), body)
            own.vx, own.vy = float(v[0]), float(v[1])
            result.append(own)
        return result

    def control(self, plan: Plan, dt: float) -> np.ndarray:
        owns = self.owns()
        states = [
            Shared(i, 0, o.x, o.y, o.vx, o.vy, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 0.0, 0.0, 0.0)
            for i, o in enumerate(owns)
        ]
        us = []
        for own, view, law in zip(owns, self.views, self.laws, strict=True):
            fresh = [(a, states[j]) for j, a in view.row]
            others = [(s.x, s.y, s.vx, s.vy) for s in states if s.robot != view.robot]
            us.append(law.control(own, fresh, others, plan, dt))
        return np.array(us)

    def run(self, plan: Plan, seconds: float, dt: float = 0.02) -> "Group":
        for _ in range(round(seconds / dt)):
            u = self.control(plan, dt)
            self.vs += dt * u
            self.xs += dt * self.vs
            self.t += dt
        return self


def scenario(algorithm: str, **values) -> Scenario:
    chosen = {"algorithm": algorithm, **{name.replace("__", "."): value for name, value in values.items()}}
    return load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])


SPREAD = [(0, 0), (9, 1), (1, 8), (-7, 3), (4, -9)]
V_C = (0.5, -0.3)


@pytest.mark.parametrize("topology", ["all", "ring", "line", "star"])
def test_parallel_motion_of_dcs_reaches_the_formation_and_the_reference_velocity(topology):
    """Corollary 2; the convergence is exponential, not finite-time, so the test asks for a small error, not for none."""
    group = Group(scenario("dcs", topology=topology, dcs__repulsion=False), SPREAD, np.zeros((5, 2)))
    group.run(Plan(TRACE, (0.0, 0.0), v_c=V_C), seconds=150.0)
    h = np.array([law._h[i] for i, law in enumerate(group.laws)])
    formation = group.xs - h
    assert np.ptp(formation, axis=0).max() < 0.05
    assert np.abs(group.vs - V_C).max() < 0.02


@pytest.mark.parametrize(("orbits", "shares"), [("one", [1.0] * 5), ("spread", [0.2, 0.4, 0.6, 0.8, 1.0])])
def test_circular_motion_of_dcs_turns_about_the_decided_source(orbits, shares):
    """Corollary 3: x_i - h_i -> h^c and v_i -> h_i', at the rate of Table 5.4 and its radius, or at shares of it."""
    s = scenario("dcs", topology="ring", dcs__repulsion=False, dcs__orbits=orbits)
    group = Group(s, SPREAD, np.zeros((5, 2)))
    plan = Plan(LOST, (20.0, 10.0), centre=(20.0, 10.0))
    group.run(plan, seconds=120.0)
    offset = group.xs - (20.0, 10.0)
    assert np.hypot(*offset.T) == pytest.approx([s.dcs.circle * share for share in shares], rel=0.02)
    assert np.hypot(*group.vs.T) == pytest.approx([s.dcs.circle * s.dcs.turn * share for share in shares], rel=0.02)
    assert s.dcs.circle * s.dcs.turn < s.body.max_speed


@pytest.mark.parametrize("topology", ["all", "line"])
def test_simple_law_agrees_on_the_reference_velocity(topology):
    group = Group(scenario("simple", topology=topology, repulsion__d=0.01, repulsion__d0=0.01), SPREAD, np.zeros((5, 2)))
    group.run(Plan(TRACE, (0.0, 0.0), v_c=V_C), seconds=20.0)
    assert np.abs(group.vs - V_C).max() < 1e-3


def test_cfpso_reaches_its_target_and_rests_there():
    group = Group(scenario("cfpso", cfpso__repulsion=False), SPREAD, np.zeros((5, 2)))
    group.run(Plan(TRACE, (3.0, 2.0)), seconds=40.0)
    assert np.abs(group.xs - (3.0, 2.0)).max() < 1e-3
    assert np.abs(group.control(Plan(TRACE, (3.0, 2.0)), 0.02)).max() < 1e-2


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@given(shift=points)
@settings(max_examples=10, deadline=None)
def test_laws_do_not_depend_on_where_the_origin_is(algorithm, shift):
    dx, dy = shift
    here = Group(scenario(algorithm), SPREAD, np.full((5, 2), 0.1))
    there = Group(scenario(algorithm), np.array(SPREAD) + shift, np.full((5, 2), 0.1))
    for mode in (TRACE, LOST):
        u = here.control(Plan(mode, (5.0, 5.0), v_c=V_C, centre=(5.0, 5.0)), 0.05)
        moved = Plan(mode, (5.0 + dx, 5.0 + dy), v_c=V_C, centre=(5.0 + dx, 5.0 + dy))
        assert there.control(moved, 0.05) == pytest.approx(u, rel=1e-6, abs=1e-6)
