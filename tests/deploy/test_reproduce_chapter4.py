"""Chapter 4's examples: the curves against closed forms, the chatter and the tails against theory, (4.25) against two
other ways to decide it."""

from __future__ import annotations

import math
import sys

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deploy.reproduce.chapter4.admissible import region_against_roots
from deploy.reproduce.chapter4.continuous import FPSO, PSO
from deploy.reproduce.chapter4.dfpso import chatter, critical_gain, in_region, particle
from deploy.reproduce.chapter4.discrete import SWARMS, swarm
from deploy.reproduce.chapter4.finite_time import robot_gains, smallest_on_circle
from deploy.reproduce.chapter4.fpso import START, Gains, force, implicit, integrate, rate, rates, tail
from deploy.reproduce.chapter4.lmi import (
    bounded_real,
    certificate,
    inequality,
    largest_beta,
    largest_varpi,
    reach,
    solve,
    spread,
    system,
)
from deploy.reproduce.kinds import DIFFERS, Options
from protocol.errors import ScenarioError
from protocol.messages import Reading
from protocol.scenario import Scenario, robot_view
from robot_agent.control.cfpso import CfpsoControl
from robot_agent.hand import Own
from robot_agent.interfaces import TRACE, Plan
from robot_agent.sig import implicit_step

DK = 0.5
TABLE = [Gains(-0.7, 8.5, 0.5, 0.01), Gains(-2.1, 8.5, 0.5, 0.01), Gains(-0.5, 8.0, 0.5, 0.01)]


@st.composite
def gains(draw: st.DrawFn) -> Gains:
    """Well inside Omega_d for a step of 0.5 s, so that what is transient is soon over."""
    gamma = draw(st.floats(0.2, 1.0))
    pull, share = draw(st.floats(0.3, 1.5)), draw(st.floats(0.15, 0.8))
    alpha = share * (4.0 - 2.0 * pull) / (gamma * DK * DK)
    return Gains(1.0 - pull / (gamma * DK), alpha, gamma, draw(st.floats(0.01, 0.5)), draw(st.floats(0.3, 0.7)))


def test_the_force_is_the_one_that_the_robots_law_makes() -> None:
    g = robot_gains(beta=1.9)
    scenario = msgspec.structs.replace(Scenario(), algorithm="cfpso")
    view = robot_view(scenario, 0)
    view = msgspec.structs.replace(
        view,
        cfpso=msgspec.structs.replace(view.cfpso, repulsion=False, beta=1.9),
        control=msgspec.structs.replace(view.control, step="explicit"),
    )
    own = Own(Reading(0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), view.body)
    own.x, own.vx, own.y, own.vy = 5.0, -9.0, -0.3, 2.0
    u = CfpsoControl(view).control(own, (), (), Plan(TRACE, target=(0.0, 0.0)), 0.05)
    assert u == pytest.approx((force(5.0, -9.0, g), force(-0.3, 2.0, g)), rel=1e-14)


def test_the_particle_swarm_moves_as_its_closed_form_says() -> None:
    curve = integrate(PSO, 30.0)
    roots = np.roots([1.0, 1.0 - PSO.omega, PSO.alpha])
    weights = np.linalg.solve(np.array([[1.0, 1.0], roots]), np.array(START))
    exact = (weights[:, None] * np.exp(roots[:, None] * curve.t)).sum(axis=0).real
    assert curve.y[0] == pytest.approx(exact, abs=1e-6)


def test_settling_times_are_the_limit_of_a_refined_step() -> None:
    exact = integrate(FPSO, 60.0, floor=1e-3).settled(1e-2)
    coarse, fine = (abs(implicit(FPSO, 40.0, dt=dt, floor=1e-3).settled(1e-2) - exact) for dt in (4e-3, 5e-4))
    assert fine < 0.25 * coarse
    assert fine < 0.05
    assert exact < 0.5 * integrate(PSO, 120.0, floor=1e-3).settled(1e-2)


def test_the_energy_of_the_proof_never_grows() -> None:
    g = FPSO
    y1, y2 = integrate(g, 20.0).y
    phi = (1 - g.omega) * y2 + g.alpha * y1
    c = 1 - g.omega
    V = g.beta * c / (g.a + 1) * abs(phi) ** (g.a + 1) + g.gamma * c / 2 * phi**2 + g.alpha * c / 2 * y2**2  # (4.15)
    assert np.all(np.diff(V) <= 1e-9 * V[0])
    assert V[-1] < 0.2 * V[0]


@pytest.mark.parametrize("beta", [0.5, 4.0])
@pytest.mark.parametrize(("omega", "alpha"), [(-0.5, 8.0), (-2.0, 3.0)])
def test_the_way_ends_exponentially_whatever_beta_is(omega: float, alpha: float, beta: float) -> None:
    g = Gains(omega, alpha, 0.5, beta)
    curve = tail(g, 60.0, dt=1e-4, floor=1e-14)
    assert rate(curve, 1e-8, 1e-12) == pytest.approx(alpha / (1 - omega), rel=2e-3)
    # the same in every decade: a finite time would need a rate without bound
    slopes = rates(curve, [10.0**-k for k in range(8, 13)])
    assert max(slopes) < 1.005 * min(slopes)


@given(omega=st.floats(-5, 0.9), alpha=st.floats(0.1, 20))
def test_the_constant_of_the_proof_is_zero(omega: float, alpha: float) -> None:
    assert smallest_on_circle(Gains(omega, alpha)) < 1e-12 * (alpha**2 + (1 - omega) ** 2)


@pytest.mark.parametrize("name", ["PSO", "GPSO"])
def test_positions_and_velocities_move_as_the_recurrence_of_positions(name: str) -> None:
    g, dk = SWARMS[name]
    x = particle(g, dk, 60).y[0]
    gamma_1 = 2 - (1 - g.omega) * dk - g.alpha * dk**2  # (4.4), which is (4.3) for dk = 1
    gamma_2 = (1 - g.omega) * dk - 1
    assert x[2:] == pytest.approx(gamma_1 * x[1:-1] + gamma_2 * x[:-2], abs=1e-11)


@settings(deadline=None, max_examples=60)
@given(g=gains())
def test_the_printed_particle_ends_between_two_places_that_can_be_calculated(g: Gains) -> None:
    phi, place = chatter(g, DK)
    curve = particle(g, DK, 4000)
    assert abs(curve.y[0, -20:]) == pytest.approx(np.full(20, place), rel=1e-6)
    assert curve.y[0, -1] == pytest.approx(-curve.y[0, -2], rel=1e-6)
    assert abs(g.phi(*curve.y[:, -1])) == pytest.approx(phi, rel=1e-6)


def test_the_figures_swing_and_chatter_as_far_as_theory_says() -> None:
    assert [round(float(np.abs(particle(g, dk, 200).y[0]).max()), 1) for g, dk in SWARMS.values()] == [13.2, 7.7, 8.9]
    g, dk = SWARMS["DFPSO"]
    assert chatter(g, dk)[1] == pytest.approx(3.567e-3, rel=1e-3)


@settings(deadline=None, max_examples=20)
@given(g=gains())
def test_the_robots_step_does_not_chatter(g: Gains) -> None:
    assert particle(g, DK, 4000, law=implicit_step).size()[-1] < 1e-3 * chatter(g, DK)[1]


@given(g=gains())
def test_the_critical_gain_is_where_the_linear_part_loses_its_stability(g: Gains) -> None:
    top = critical_gain(g, DK)
    for gamma, stable in ((0.999 * top, True), (1.001 * top, False)):
        A, _ = system(Gains(g.omega, g.alpha, gamma), DK)
        assert (np.abs(np.linalg.eigvals(A)).max() < 1.0) == stable


@pytest.mark.parametrize("seed", range(3))
def test_omega_d_is_where_the_linear_part_is_stable(seed: int) -> None:
    wrong, points = region_against_roots(seed, 1000)
    assert (wrong, points) == (0, 1000)


@pytest.mark.parametrize("g", TABLE)
def test_a_certificate_lets_no_disturbance_of_its_size_raise_v(g: Gains) -> None:
    found = solve(g, DK)
    assert found is not None
    P = np.linalg.inv(found.Q)
    assert np.linalg.eigvalsh(P).min() > 0
    A, H = system(g, DK)
    rng = np.random.default_rng(0)
    etas, fs = rng.normal(size=(2, 2000, 2))
    # f of every direction, as large as (4.29) lets it be
    fs *= (math.sqrt(found.varpi) * np.linalg.norm(etas @ H.T, axis=1) / np.linalg.norm(fs, axis=1))[:, None]
    after = etas @ A.T + fs
    before, then = ((v @ P * v).sum(axis=1) for v in (etas, after))
    assert np.all(then < before)


@pytest.mark.parametrize("g", TABLE)
def test_the_largest_beta_is_what_the_bounded_real_lemma_says(g: Gains) -> None:
    beta = largest_beta(g.omega, g.alpha, g.gamma, DK)
    assert beta == pytest.approx(math.sqrt(bounded_real(g, DK) / spread(DK)), rel=1e-5)
    found = largest_varpi(g, DK)
    assert found is not None
    assert np.linalg.eigvalsh(inequality(g, DK, found.varpi, found.Q)).max() < 0 < np.linalg.eigvalsh(found.Q).min()


def test_near_the_edge_the_answer_is_right_or_a_sentence_never_a_wrong_number() -> None:
    told, sentences = 0, []
    for distance in (1e-1, 1e-2, 1e-3, 1e-6):
        g = Gains(-0.7, (1 - distance) * (4 - 0.5 * 1.7) / 0.125, 0.5)
        try:
            beta = largest_beta(g.omega, g.alpha, g.gamma, DK)
        except ScenarioError as error:
            sentences.append(str(error))
        else:
            told += 1
            assert beta == pytest.approx(math.sqrt(bounded_real(g, DK) / spread(DK)), rel=1e-3)
    assert all("too close to the edge of Omega_d" in sentence for sentence in sentences)
    assert told >= 2


def test_feasibility_is_lost_once_and_for_all_at_the_largest_beta() -> None:
    g = TABLE[0]
    beta = largest_beta(g.omega, g.alpha, g.gamma, DK)
    shares = [0.001, 0.1, 0.5, 0.9, 0.999, 1.001, 1.1, 2.0, 10.0]
    feasible = [solve(Gains(g.omega, g.alpha, g.gamma, share * beta), DK) is not None for share in shares]
    assert feasible == [share < 1 for share in shares]


def test_the_largest_beta_by_bisection_is_the_same() -> None:
    omega, alpha, low, high = -2.1, 8.5, 1e-3, 1.0
    for _ in range(12):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if solve(Gains(omega, alpha, 0.5, middle), DK) else (low, middle)
    assert low <= largest_beta(omega, alpha, 0.5, DK) * (1 + 1e-5) <= high * (1 + 2e-5)


def test_a_matrix_that_is_no_solution_is_called_none() -> None:
    g = TABLE[0]
    assert not certificate(g, DK, 1e-5, np.eye(2)).holds
    assert not certificate(g, DK, 1e-5, -100.0 * np.eye(2)).holds


@pytest.mark.parametrize("g", [Gains(1.5, 8.5, 0.5, 0.01), Gains(-0.7, 40.0, 0.5, 0.01), Gains(-8.0, 1.0, 0.5, 0.01)])
def test_outside_omega_d_no_beta_is_admitted(g: Gains) -> None:
    assert not in_region(g, DK)
    assert solve(g, DK) is None
    assert largest_beta(g.omega, g.alpha, g.gamma, DK) == 0.0


@given(eps=st.floats(1.0, 1e8), a=st.floats(0.1, 0.9))
def test_an_eps_covers_what_it_reaches_and_nothing_below(eps: float, a: float) -> None:
    g = Gains(-0.7, 8.5, 0.5, 0.01, a)
    edge = reach(g, eps)
    for phi, covered in ((1.001 * edge, True), (0.999 * edge, False)):
        assert (phi ** (2 * a) <= eps * phi * phi) == covered


def test_a_smaller_reach_costs_beta() -> None:
    one = largest_beta(-0.7, 8.5, 0.5, DK)
    assert largest_beta(-0.7, 8.5, 0.5, DK, eps=100.0) == pytest.approx(one / 10, rel=1e-9)


def test_without_cvxpy_one_sentence_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cvxpy", None)
    with pytest.raises(ScenarioError, match=r"cvxpy, which is not installed: pip install 'odourswarm\[lmi\]'"):
        solve(TABLE[0], DK)


def test_the_inequality_needs_a_beta() -> None:
    with pytest.raises(ScenarioError, match="beta is 0"):
        solve(Gains(-0.7, 8.5, 0.5), DK)


def test_figure_4_7_says_that_it_does_not_converge() -> None:
    rows = {row.quantity: row for row in swarm("DFPSO", Options()).rows}
    assert rows["converges"].verdict == DIFFERS
