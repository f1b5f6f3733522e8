"""Chapter 6 run again: the examples as points, section 6.3 as a swarm in memory."""

import numpy as np
import pytest

from deploy.reproduce.chapter6.circular import GAINS, leader, rates
from deploy.reproduce.chapter6.coordination import EXAMPLE_1, D, disagreement, nearest
from deploy.reproduce.chapter6.parallel import V_C, late
from deploy.reproduce.chapter6.robots import circular, parallel, scenario_of
from deploy.reproduce.chapter6.tracking import V_HAT, chase, conditions
from deploy.reproduce.chapter6.virtual_robots import Follow, example_potential, example_start, settled, simulate
from deploy.reproduce.kinds import AGREES, Options
from deploy.reproduce.registry import find


@pytest.mark.parametrize("name", ["fig-6.1", "fig-6.3", "fig-6.5", "fig-6.9", "fig-6.10", "fig-6.15"])
def test_every_picture_of_chapter_6_can_be_asked_for(name):
    assert find(name).name == name


def test_velocities_agree_before_the_formation_stands_and_refining_the_step_keeps_both_times():
    times = []
    for dt in (4e-3, 2e-3):
        course = simulate(example_start(1), example_potential(D), EXAMPLE_1, 4.0, dt=dt, every=round(0.02 / dt))
        agreed = settled(course.t, disagreement(course).max(axis=1), 1e-2)
        formed = settled(course.t, nearest(course), 0.05 * D)
        assert agreed < formed < 3.5
        times.append((agreed, formed))
    assert times[1] == pytest.approx(times[0], abs=0.05)


def test_velocity_consensus_keeps_its_mean_on_a_symmetric_start():
    """sig is odd: velocities that lie symmetrically about their mean keep it."""
    start = [hat._replace(vx=v, vy=-v) for hat, v in zip(example_start(0), (2, -2, 1, -1, 3, -3), strict=True)]
    course = simulate(start, example_potential(D), EXAMPLE_1, 2.0, dt=4e-3, every=50)
    assert np.abs(course.v_hat.mean(axis=1)).max() < 1e-9


def test_robot_behind_its_virtual_one_arrives_at_a_time_that_refinement_does_not_move():
    courses = [chase(1.0, -V_HAT, Follow(), dt, dt, 6.0) for dt in (1e-3, 5e-4)]
    arrivals = [settled(t, np.abs(errors[:, 0]), 1e-4) for t, errors in courses]
    assert arrivals[1] == pytest.approx(4.85, abs=0.05)
    assert arrivals[0] == pytest.approx(arrivals[1], abs=0.05)


def test_implicit_step_of_the_tracking_law_comes_to_rest_where_the_printed_one_chatters():
    rest = {law_dt: np.abs(chase(1.0, -V_HAT, Follow(), 0.01, law_dt)[1][-100:, 1]).max() for law_dt in (0.0, 0.01)}
    assert rest[0.0] > 1e-3
    assert rest[0.01] < 1e-9


def test_the_thesis_has_three_conditions_on_k_and_only_one_is_near_its_7():
    least = list(conditions(Follow(), 0.8).values())
    assert least == pytest.approx([3.33, 21.03, 6.94], abs=0.01)


def test_real_robots_reach_the_reference_velocity_of_example_3():
    gains = EXAMPLE_1._replace(lam=0.5)
    course = simulate(
        example_start(0), example_potential(D), gains, 10.0, dt=5e-3, reference=lambda t: (V_C, (0.0, 0.0)), follow=Follow()
    )
    assert late(course)[0].max() > 1.0
    assert late(course)[-1].max() < 0.05
    assert np.abs(course.x - course.x_hat)[-1].max() < 0.05


@pytest.mark.parametrize(("cut", "near"), [(True, False), (False, True)])
def test_virtual_robot_on_the_circle_draws_only_those_within_its_range(cut, near):
    """Example 4: r = 1.2 d = 3 m, and the robots start tens of metres away."""
    course = simulate(
        example_start(0, robots=5), example_potential(2.5), GAINS, 30.0, dt=0.01, every=100, reference=rates,
        leader=leader, cut=cut,
    )  # fmt: skip
    away = np.linalg.norm(course.x_hat[-1] - leader(course.t[-1]), axis=1)
    assert (away.max() < 5.0) == near
    assert np.linalg.norm(course.v_hat[-1] - rates(course.t[-1])[0], axis=1).max() < 0.05


def test_scenarios_of_section_6_3_have_the_values_of_tables_6_1_and_6_2():
    p = scenario_of("fig-6.10", 0)
    assert (p.ftmcs.lam, p.ftmcs.gamma, p.ftmcs.beta, p.ftmcs.q, p.ftmcs.k, p.ftmcs.k1) == (0.4, 1.0, 0.5, 0.6, 7.0, 0.5)
    assert p.ftmcs.reach * p.ftmcs.d == pytest.approx(5.0)
    assert p.drill.velocity == (0.4, -0.2)
    c = scenario_of("fig-6.15", 0)
    assert (c.ftmcs.circle_lam, c.ftmcs.circle_beta, c.ftmcs.circle, c.ftmcs.turn) == (0.6, 0.3, 8.0, 0.02)
    assert c.ftmcs.reach * c.ftmcs.circle_d == pytest.approx(9.0)
    assert (p.robots, c.robots, c.drill.centre) == (3, 3, (0.0, 0.0))


def test_three_robots_form_up_and_take_v_c():
    result = parallel(Options(bus="memory"), max_time=10.0, timing__tick=0.05)
    verdicts = {row.quantity: row.verdict for row in result.rows}
    assert verdicts["distances of the three pairs at the end"] == AGREES
    assert verdicts["linear velocity"] == AGREES
    assert verdicts["heading"] == AGREES
    assert set(result.figures) == {"", "curves"}


def test_three_robots_circle_with_the_virtual_robot():
    result = circular(Options(bus="memory"), max_time=32.0, timing__tick=0.05)
    verdicts = {row.quantity: row.verdict for row in result.rows}
    assert verdicts["velocities from h_r' in the second half of the run"] == AGREES
    assert float(str(result.numbers["min_pair_distance"])) > 1.0
