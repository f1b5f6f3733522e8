"""dcs-ft and cfpso-ft reach agreement and their targets in finite time; the printed laws do not."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deploy.memory_run import run_in_memory
from deploy.reproduce.double_integrators import (
    exponential_rate,
    finite_time_consensus,
    finite_time_tracking,
    printed_consensus,
    printed_tracking,
    rates,
    run,
)
from deploy.reproduce.settling import consensus_scale, consensus_time, energy, settling_bound, unsaturated_energy
from protocol.errors import ScenarioError
from protocol.messages import Reading, Shared
from protocol.scenario import Scenario, robot_view
from protocol.scenario.laws import Cfpso, CfpsoFt
from protocol.scenario.load import load_scenario
from protocol.topology.find import find_graph
from protocol.topology.graph import make_graph
from robot_agent.algorithms import ALGORITHMS
from robot_agent.control.homogeneous import Law, pull
from robot_agent.hand import Own, top_acceleration
from robot_agent.interfaces import LOST, TRACE, Plan

LINE = find_graph("fig-5.3", 3)
X, V = [-9.0, 0.0, 9.0], [20.0, 4.0, -20.0]  # the example of (5.1)
THREE = Law(0.6, 0.5, 0.9)  # its alpha, beta and gamma
ONE = Law(0.5, 1.0, 1.2)

exponents = st.floats(0.2, 0.85)
gains = st.floats(0.3, 3.0)
errors = st.floats(-10.0, 10.0)


# --- the two kinds of convergence, told apart by the slope of the logarithm of the error


def test_printed_consensus_falls_along_a_straight_line():
    """(5.1): the position obeys gamma y' = -beta y in the end, whatever the sig term does."""
    beta, gamma, dt = 0.5, 0.9, 0.005
    found = run(printed_consensus(LINE, beta, gamma, 0.6, dt), X, V, dt, 40.0, agree=True)
    slopes = [exponential_rate(r) for r in rates(found.decade_times(3, 8))]
    assert slopes == pytest.approx([beta / gamma] * 5, rel=0.02)


def test_finite_time_consensus_bends_down_beyond_any_rate():
    """Each decade takes about 10^-((1-a1)/2) of the time of the one before, until sampling ends it."""
    dt = 0.005
    found = run(finite_time_consensus(LINE, THREE, dt), X, V, dt, 25.0, agree=True)
    slopes = rates(found.decade_times(0, 10))
    early, middle, late = (sum(slopes[k : k + 2]) / 2 for k in (0, 4, 8))
    assert middle > 3.0 * early
    assert late > 3.0 * middle
    assert late > 10.0 * 0.5 / 0.9 / math.log(10)  # ten times what (5.1) ever reaches
    assert found.x[-1] < 1e-12
    assert found.v[-1] < 1e-9


def test_printed_tracking_ends_in_a_straight_line():
    """(4.12) with the gains of Table 4.5: (1 - omega) y' = -alpha y in the end."""
    p, dt = Cfpso(), 0.002
    law = printed_tracking(p.omega, p.alpha, p.a, p.gamma, p.beta, dt)
    found = run(law, [5.0], [-9.0], dt, 36.0, agree=False)
    slopes = [exponential_rate(r) for r in rates(found.decade_times(9, 14))]
    assert slopes == pytest.approx([p.alpha / (1.0 - p.omega)] * 5, rel=0.03)


def test_finite_time_tracking_bends_down_beyond_any_rate():
    dt = 0.002
    found = run(finite_time_tracking(ONE, dt), [5.0], [-9.0], dt, 14.0, agree=False)
    slopes = rates(found.decade_times(0, 9))
    early, middle, late = (sum(slopes[k : k + 2]) / 2 for k in (0, 3, 7))
    assert middle > 3.0 * early
    assert late > 6.0 * middle
    assert late > 10.0 * Cfpso().alpha / (1.0 - Cfpso().omega) / math.log(10)  # ten times what (4.12) ever reaches
    assert found.x[-1] == 0.0


def test_sampling_alone_ends_the_bend():
    """The last three decades before round-off take time in proportion to the step; the settling time converges."""
    ends, settled = [], []
    for dt in (0.008, 0.004, 0.002):
        found = run(finite_time_tracking(ONE, dt), [5.0], [-9.0], dt, 14.0, agree=False)
        decades = found.decade_times(9, 12)
        ends.append(decades[-1] - decades[0])
        settled.append(found.settled(1e-9, 1e-9))
    assert all(finer < 0.75 * coarser for coarser, finer in pairwise(ends))
    assert (settled[0] - settled[1]) / (settled[1] - settled[2]) == pytest.approx(2.0, rel=0.3)


# --- the law


@given(a1=exponents, k1=gains, k2=gains, e=errors, w=errors, L=st.floats(0.2, 5.0))
def test_the_law_is_homogeneous(a1, k1, k2, e, w, L):
    law = Law(a1, k1, k2)
    there = pull(law, L**2 * e, L ** (1.0 + a1) * w, 0.0, 1.0)
    assert there == pytest.approx(L ** (2.0 * a1) * pull(law, e, w, 0.0, 1.0), rel=1e-9, abs=1e-9)


@given(a1=exponents, k1=gains, k2=gains, e=errors, w=errors)
def test_the_held_law_becomes_that_of_continuous_time_as_the_step_shrinks(a1, k1, k2, e, w):
    if min(abs(e), abs(w)) > 0.05:
        law = Law(a1, k1, k2)
        assert pull(law, e, w, 1e-8, 1.0) == pytest.approx(pull(law, e, w, 0.0, 1.0), rel=1e-4, abs=1e-5)


@given(e=errors, w=errors, dt=st.floats(0.0, 1.0), K=st.floats(1.0, 20.0))
def test_the_law_keeps_to_its_limits_and_is_odd(e, w, dt, K):
    law = Law(0.5, 3.0, 3.0, 0.4, 0.3)
    assert abs(pull(law, e, w, dt, K)) <= 0.7 + 1e-12
    assert pull(law, -e, -w, dt, K) == -pull(law, e, w, dt, K)


def test_motion_is_of_first_order_in_the_step():
    exact = run(finite_time_tracking(ONE, 1e-4), [1.0], [0.5], 1e-4, 2.0, agree=False).x[-1]
    off = [
        abs(run(finite_time_tracking(ONE, dt), [1.0], [0.5], dt, 2.0, agree=False).x[-1] - exact)
        for dt in (0.04, 0.02, 0.01)
    ]
    assert [a / b for a, b in pairwise(off)] == pytest.approx([2.0, 2.0], rel=0.2)


def test_the_explicit_step_chatters_in_a_band_of_the_order_that_homogeneity_gives():
    """Half the step: e shrinks by 2^(2/(1-a1)) = 16, w by 2^((1+a1)/(1-a1)) = 8; the implicit step leaves no band."""
    band_x, band_v = [], []
    for dt, scale in ((0.2, 1.0), (0.1, 0.25)):  # L = 2^(-1/(1-a1)) = 1/4 makes the two runs one
        start = ([scale**2 * 1.0], [scale**1.5 * 0.3])
        found = run(finite_time_tracking(ONE, dt, held=False), *start, dt, 2000 * dt, agree=False)
        band_x.append(max(found.x[-200:]))
        band_v.append(max(found.v[-200:]))
        quiet = run(finite_time_tracking(ONE, dt), *start, dt, 2000 * dt, agree=False)
        assert max(quiet.x[-200:]) < 1e-9 * band_x[-1]
        assert max(quiet.v[-200:]) < 1e-9 * band_v[-1]
    assert band_x[0] / band_x[1] == pytest.approx(16.0, rel=1e-6)
    assert band_v[0] / band_v[1] == pytest.approx(8.0, rel=1e-6)


@given(a1=st.floats(0.2, 0.6), k=gains, damping=st.floats(0.6, 1.5), dt=st.floats(0.05, 1.0), e=errors, w=errors)
@settings(max_examples=20)
def test_the_held_law_settles_at_any_step(a1, k, damping, dt, e, w):
    law = Law(a1, k, damping * k ** (1.0 / (1.0 + a1)))
    found = run(finite_time_tracking(law, dt), [e], [w], dt, 80.0 + 200 * dt, agree=False)
    assert energy(law, found.x[-1], found.v[-1]) < 1e-9 * max(energy(law, e, w), 1.0)


@pytest.mark.parametrize("topology", ["all", "ring", "line", "star"])
@pytest.mark.parametrize("dt", [0.05, 0.5])
def test_a_graph_that_steps_at_once_settles(topology, dt):
    x, v = [0.0, 9.0, 1.0, -7.0, 4.0], [0.3, -0.1, 0.5, -0.6, 0.2]
    control = finite_time_consensus(find_graph(topology, 5), Law(0.5, 0.5, 0.6), dt)
    found = run(control, x, v, dt, max(80.0, 1000 * dt), agree=True)
    assert found.x[-1] < 1e-9
    assert found.v[-1] < 1e-9


@given(x=st.lists(errors, min_size=5, max_size=5), v=st.lists(errors, min_size=5, max_size=5))
def test_an_edge_pulls_its_ends_alike_so_that_the_mean_is_kept(x, v):
    control = finite_time_consensus(find_graph("star", 5), Law(0.5, 0.5, 0.6, 0.3, 0.2), 0.05)
    assert sum(control(x, v)) == pytest.approx(0.0, abs=1e-12)


# --- how long it takes


@pytest.mark.parametrize(("e", "w"), [(1.0, 0.0), (0.2, 0.1), (0.0, 0.8), (5.0, -9.0), (1.0, 0.8)])
@pytest.mark.parametrize("law", [ONE, Law(1 / 3, 1.0, 1.0), Law(0.6, 2.0, 1.0)])
def test_settling_time_is_within_the_proved_bound_and_not_far_below(law, e, w):
    bound, dt = settling_bound(law, e, w), 0.005
    found = run(finite_time_tracking(law, dt), [e], [w], dt, 1.1 * bound, agree=False).settled(1e-8, 1e-8)
    assert found <= bound + dt
    assert found > 0.6 * bound


@given(L=st.floats(0.1, 10.0))
@settings(max_examples=10)
def test_the_bound_scales_as_the_settling_time_does(L):
    ours, theirs = settling_bound(ONE, L**2 * 0.7, -(L**1.5) * 0.4), settling_bound(ONE, 0.7, -0.4)
    assert ours == pytest.approx(L**0.5 * theirs, rel=1e-6)


def test_the_bound_is_refused_where_the_law_saturates():
    law = Law(0.5, 1.0, 1.2, 0.45, 0.45)
    assert settling_bound(law, 0.1, 0.05) > 0.0
    with pytest.raises(ScenarioError, match=r"may saturate.*Start nearer"):
        settling_bound(law, 5.0, 0.0)


@given(e=errors, w=errors)
@settings(max_examples=12)
def test_the_saturated_law_comes_to_where_it_no_longer_saturates_and_settles(e, w):
    p, dt = CfpsoFt(), 0.05
    law = Law(p.a1, p.k1, p.k2, p.position_limit, p.velocity_limit)
    found = run(finite_time_tracking(law, dt), [e], [w / 4.0], dt, 80.0, agree=False)
    within = [energy(law, x, v) <= unsaturated_energy(law) for x, v in zip(found.x, found.v, strict=True)]
    assert all(within[within.index(True) :])
    assert found.x[-1] < 1e-9


def test_consensus_times_follow_from_one_level_of_the_energy():
    graph = find_graph("fig-5.3", 3)
    scale = consensus_scale(graph, THREE, starts=24, dt=0.01)
    found = run(finite_time_consensus(graph, THREE, 0.005), X, V, 0.005, 26.0, agree=True).settled(1e-8, 1e-8)
    assert 0.5 * consensus_time(scale, graph, THREE, X, V) < found < 1.1 * consensus_time(scale, graph, THREE, X, V)


def test_no_consensus_time_is_given_for_a_graph_without_a_theorem():
    with pytest.raises(ScenarioError, match="undirected and connected"):
        consensus_scale(make_graph(3, [(0, 1), (1, 2), (2, 0)]), THREE)
    with pytest.raises(ScenarioError, match="undirected and connected"):
        consensus_scale(make_graph(3, [(0, 1)], directed=False), THREE)


# --- the controllers


class Group:
    """Double integrators (1.7) under a scenario's controller, each robot with its neighbours' states of this tick."""

    def __init__(self, scenario: Scenario, xs, vs):
        views = [robot_view(scenario, i) for i in range(scenario.robots)]
        self.rows = [view.row for view in views]
        self.laws = [ALGORITHMS[scenario.algorithm].controller(view) for view in views]
        self.body = scenario.body
        self.xs, self.vs, self.t = np.array(xs, float), np.array(vs, float), 0.0

    def _own(self, i: int, x: float, y: float, vx: float, vy: float) -> Own:
        own = Own(Reading(i, 0, self.t, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0), self.body)
        own.x, own.y, own.vx, own.vy = x, y, vx, vy
        return own

    def run(self, plan: Plan, seconds: float, dt: float = 0.05) -> "Group":
        for _ in range(round(seconds / dt)):
            owns = [self._own(i, *x, *v) for i, (x, v) in enumerate(zip(self.xs.tolist(), self.vs.tolist(), strict=True))]
            told = [
                Shared(i, 0, o.x, o.y, o.vx, o.vy, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 0.0, 0.0, 0.0)
                for i, o in enumerate(owns)
            ]
            u = np.array([
                law.control(own, [(a, told[j]) for j, a in row], [], plan, dt)
                for own, row, law in zip(owns, self.rows, self.laws, strict=True)
            ])  # fmt: skip
            self.xs += dt * self.vs + 0.5 * dt**2 * u
            self.vs += dt * u
            self.t += dt
        return self


def scenario(algorithm: str, **values) -> Scenario:
    chosen = {"algorithm": algorithm, **{name.replace("__", "."): value for name, value in values.items()}}
    return load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])


SPREAD = [(0, 0), (9, 1), (1, 8), (-7, 3), (4, -9)]
V_C = (0.5, -0.3)


@pytest.mark.parametrize("topology", ["ring", "line"])
def test_parallel_motion_takes_the_formation_and_the_reference_velocity_to_round_off(topology):
    group = Group(scenario("dcs-ft", topology=topology), SPREAD, np.zeros((5, 2)))
    places = np.array(group.laws[0]._h)
    group.xs = places + 0.25 * np.array(SPREAD)
    group.run(Plan(TRACE, (0.0, 0.0), v_c=V_C), seconds=60.0)
    formation = group.xs - places
    assert np.ptp(formation, axis=0).max() < 1e-9
    assert np.abs(group.vs - V_C).max() < 1e-9


def test_circular_motion_turns_about_the_centre():
    """Held for a tick, the turning reference h_i'' leaves an error of the order of the step; the rest is gone."""
    s = scenario("dcs-ft", topology="ring")
    group = Group(s, SPREAD, np.zeros((5, 2))).run(Plan(LOST, (20.0, 10.0), centre=(20.0, 10.0)), seconds=100.0)
    offset, radii = group.xs - (20.0, 10.0), s.dcs_ft.circle * np.arange(1, 6) / 5
    assert np.hypot(*offset.T) == pytest.approx(radii, rel=1e-3)
    assert np.hypot(*group.vs.T) == pytest.approx(radii * s.dcs_ft.turn, rel=1e-2)
    assert s.dcs_ft.circle * s.dcs_ft.turn < s.body.max_speed


def test_cfpso_ft_reaches_its_target_to_round_off_and_rests():
    group = Group(scenario("cfpso-ft"), SPREAD, np.zeros((5, 2))).run(Plan(TRACE, (3.0, 2.0)), seconds=60.0)
    assert np.abs(group.xs - (3.0, 2.0)).max() < 1e-12
    assert np.abs(group.vs).max() < 1e-12


@pytest.mark.parametrize("algorithm", ["dcs-ft", "cfpso-ft"])
@pytest.mark.parametrize("mode", [TRACE, LOST])
def test_limits_add_up_to_what_the_wheels_can_give(algorithm, mode):
    s = scenario(algorithm, topology="star")
    top = top_acceleration(s.body) + s.dcs_ft.circle * s.dcs_ft.turn**2
    far = Group(s, 100.0 * np.array(SPREAD), [(5, -5), (-5, 5), (5, 5), (0, 0), (-5, -5)])
    before = far.vs.copy()
    far.run(Plan(mode, (50.0, 50.0), v_c=V_C, centre=(50.0, 50.0)), seconds=0.05)
    assert np.abs(far.vs - before).max() / 0.05 <= top + 1e-9


def test_without_neighbours_dcs_ft_follows_its_own_reference():
    s = scenario("dcs-ft", topology="ring")
    group = Group(s, SPREAD, np.zeros((5, 2)))
    group.rows = [()] * 5
    group.run(Plan(TRACE, (0.0, 0.0), v_c=V_C), seconds=25.0)
    assert np.abs(group.vs - V_C).max() < 1e-9


@pytest.mark.parametrize("algorithm", ["dcs-ft", "cfpso-ft"])
def test_the_swarm_finds_the_source(algorithm):
    values = {"algorithm": algorithm, "topology": "line", "start.x": 60.0, "start.y": -6.0, "max_time": 300.0}
    outcome = run_in_memory(load_scenario(None, overrides=[(k, v, "test") for k, v in values.items()]))
    assert outcome.found
    assert outcome.min_pair_distance > 0.4
