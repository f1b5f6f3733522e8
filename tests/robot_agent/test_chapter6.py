"""Chapter 6: the potential, the virtual robots, the tracking law, and what a group does under them."""

import math
from itertools import pairwise

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from protocol.codec import Codec
from protocol.errors import ScenarioError
from protocol.messages import Reading, Shared
from protocol.scenario import Scenario, robot_view
from protocol.scenario.load import load_scenario
from robot_agent.agent import Agent
from robot_agent.algorithms import ALGORITHMS
from robot_agent.control.coordination import Gains, Virtual, accelerate, descend
from robot_agent.control.potential import Potential, sigma_norm
from robot_agent.control.tracking import pull
from robot_agent.hand import Own
from robot_agent.interfaces import LOST, SEARCH, TRACE, Plan
from robot_agent.sig import explicit_step, implicit_step, sig

D, R, EPSILON = 7.0, 8.4, 0.1
J = Potential(D, R, 5.0, 5.0, EPSILON, 0.2)
coordinate = st.floats(-9, 9)
points = st.tuples(coordinate, coordinate)
headings = st.floats(0, 2 * math.pi)


def energy(x: float, y: float, other, potential: Potential = J, cut: bool = True) -> float:
    """The pair's part of J: the integral of the action function, by quadrature."""
    z = sigma_norm(math.hypot(other[0] - x, other[1] - y), EPSILON)
    value, _ = quad(lambda s: potential.action(s, cut), sigma_norm(D, EPSILON), z, limit=200, epsabs=1e-12)
    return value


@settings(max_examples=60, deadline=None)
@given(here=points, other=points, cut=st.booleans())
def test_slope_is_the_derivative_of_the_potential(here, other, cut):
    x, y = here
    step = 1e-5
    by_x = (energy(x + step, y, other, cut=cut) - energy(x - step, y, other, cut=cut)) / (2 * step)
    by_y = (energy(x, y + step, other, cut=cut) - energy(x, y - step, other, cut=cut)) / (2 * step)
    assert J.slope(x, y, *other, cut=cut) == pytest.approx((by_x, by_y), rel=1e-4, abs=1e-4)


@given(here=points, other=points, turn=headings, shift=points)
def test_slope_turns_and_moves_with_the_robots_and_is_opposite_for_the_other(here, other, turn, shift):
    def moved(p):
        c, s = math.cos(turn), math.sin(turn)
        return c * p[0] - s * p[1] + shift[0], s * p[0] + c * p[1] + shift[1]

    slope = J.slope(*here, *other)
    assert J.slope(*other, *here) == pytest.approx((-slope[0], -slope[1]), abs=1e-12)
    still = moved((slope[0], slope[1]))
    assert J.slope(*moved(here), *moved(other)) == pytest.approx((still[0] - shift[0], still[1] - shift[1]), abs=1e-6)


def test_potential_rests_at_d_pushes_below_and_draws_above_and_is_flat_beyond_r():
    assert J.slope(0.0, 0.0, D, 0.0) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert J.slope(0.0, 0.0, D - 1, 0.0)[0] > 0  # downhill is away from the other
    assert J.slope(0.0, 0.0, D + 1, 0.0)[0] < 0
    assert J.slope(0.0, 0.0, R, 0.0) == (0.0, 0.0)
    assert J.slope(0.0, 0.0, R + 5, 0.0) == (0.0, 0.0)
    assert J.slope(0.0, 0.0, R + 5, 0.0, cut=False)[0] < 0


def test_unequal_attack_and_defence_keep_the_rest_distance():
    """c = |a - b| / sqrt(4 a b) is there so that phi(0) = 0."""
    uneven = Potential(D, R, 2.0, 6.0, EPSILON, 0.2)
    assert uneven.slope(0.0, 0.0, D, 0.0) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert uneven.slope(0.0, 0.0, 1.0, 0.0)[0] > -J.slope(0.0, 0.0, 8.0, 0.0)[0]


def test_attack_stronger_than_defence_is_refused_with_a_sentence():
    with pytest.raises(ScenarioError, match=r"ftmcs\.attack is 6; it must be at most ftmcs\.defence"):
        scenario(ftmcs__attack=6.0)


@given(distance=st.floats(0.0, 9.0), heading=headings)
def test_stiffness_bounds_how_fast_the_slope_changes(distance, heading):
    step = 1e-4
    x, y = distance * math.cos(heading), distance * math.sin(heading)
    near, far = J.slope(0.0, 0.0, x, y), J.slope(step, 0.0, x, y)
    assert math.hypot(far[0] - near[0], far[1] - near[1]) / step <= J.stiffness


def coordinated(hats, gains: Gains, step, dt: float, reference=(0.0, 0.0)):
    """One step of all virtual robots, all hearing all."""
    moved = []
    for i, me in enumerate(hats):
        others = [hat for j, hat in enumerate(hats) if j != i]
        a_x, a_y = accelerate(me, [(1.0, hat) for hat in others], reference, (0.0, 0.0), gains, step, dt)
        slopes = [J.slope(me.x, me.y, hat.x, hat.y) for hat in others]
        x, y = descend((sum(s for s, _ in slopes), sum(s for _, s in slopes)), gains, step, dt)
        moved.append(Virtual(me.x + dt * (me.vx + x), me.y + dt * (me.vy + y), me.vx + dt * a_x, me.vy + dt * a_y))
    return moved


STARTS = [Virtual(0, 0, 2, -1), Virtual(5, 1, -1, 2), Virtual(-3, 6, 0.5, 0.5), Virtual(-4, -5, -2, -2)]


def total(hats) -> float:
    return sum(energy(a.x, a.y, (b.x, b.y)) for i, a in enumerate(hats) for b in hats[:i])


def test_virtual_robots_fall_down_the_potential_once_their_velocities_agree():
    """Proposition 9: dV/dt <= 0."""
    hats = [hat._replace(vx=0.3, vy=-0.2) for hat in STARTS]
    gains = Gains(gamma=1.0, lam=0.0, beta=0.5, q=0.6, row_sum=3.0, stiffness=6 * J.stiffness)
    energies = [total(hats)]
    for _ in range(60):
        hats = coordinated(hats, gains, implicit_step, 0.05)
        energies.append(total(hats))
    assert all(after <= before + 1e-9 for before, after in pairwise(energies))
    assert energies[-1] < 0.5 * energies[0]
    assert all((hat.vx, hat.vy) == pytest.approx((0.3, -0.2)) for hat in hats)


def test_formation_rests_at_distance_d_and_implicit_and_explicit_agree():
    ends = {}
    for step in (implicit_step, explicit_step):
        hats = [Virtual(0, 0, 0.5, -0.2), Virtual(5, 1, -0.3, 0.4), Virtual(1, 5, 0.1, 0.1)]
        gains = Gains(gamma=1.0, lam=0.5, beta=0.5, q=0.6, row_sum=2.0, stiffness=4 * J.stiffness)
        for _ in range(3000):
            hats = coordinated(hats, gains, step, 0.01, reference=(0.4, 0.1))
        gaps = [math.hypot(a.x - b.x, a.y - b.y) for i, a in enumerate(hats) for b in hats[:i]]
        assert gaps == pytest.approx([D] * 3, abs=2e-3)
        assert [v for hat in hats for v in (hat.vx, hat.vy)] == pytest.approx([0.4, 0.1] * 3, abs=2e-3)
        ends[step] = hats
    for a, b in zip(*ends.values(), strict=True):
        assert math.hypot(a.x - b.x, a.y - b.y) < 0.15


errors = st.floats(-20, 20)


@given(e1=errors, e2=errors, dt=st.floats(1e-3, 0.2))
def test_implicit_pull_solves_its_equation(e1, e2, dt):
    k, k1, q = 7.0, 0.5, 0.6
    w = pull(e1, e2, k, k1, q, dt)
    end = e2 - dt * w
    s = sig(end, 1 / q) + k1 ** (1 / q) * (e1 + dt * end)
    assert abs(s - sig(w / k, 1 / (2 * q - 1))) < 1e-6 * (1 + abs(e1) + abs(e2) ** 2)
    assert pull(-e1, -e2, k, k1, q, dt) == -w


@given(e1=errors, e2=errors)
def test_implicit_pull_becomes_the_printed_law_as_the_step_shrinks(e1, e2):
    k, k1, q = 7.0, 0.5, 0.6
    s = sig(e2, 1 / q) + k1 ** (1 / q) * e1
    printed = k * sig(s, 2 * q - 1)
    assert pull(e1, e2, k, k1, q) == pytest.approx(printed, rel=1e-9)
    if abs(s) > 0.1:
        assert pull(e1, e2, k, k1, q, 1e-9) == pytest.approx(printed, rel=1e-3)


def decades(e1: float, law) -> list[float]:
    """How long |e_1| takes for each factor 10 from 1e-1 to 1e-5, in steps of 0.2 ms."""
    dt, e2, t, left, bounds = 2e-4, 0.0, 0.0, [], [10.0**-n for n in range(1, 6)]
    while bounds and t < 60.0:
        e2 -= dt * law(e1, e2, dt)
        e1 += dt * e2
        t += dt
        if abs(e1) < bounds[0]:
            left.append(t)
            bounds.pop(0)
    return [b - a for a, b in pairwise(left)]


def test_tracking_takes_ever_less_time_for_each_factor_ten_a_linear_law_does_not():
    """Proposition 10. On v = -k1 sig(x)^q each factor 10 takes 10^(1-q) = 2.51 times less time; a linear law: the same."""
    finite = decades(1.0, lambda e1, e2, dt: pull(e1, e2, 7.0, 0.5, 0.6, dt))
    assert len(finite) == 4
    assert all(before / after == pytest.approx(10**0.4, rel=0.1) for before, after in pairwise(finite))
    linear = decades(1.0, lambda e1, e2, dt: 0.25 * e1 + e2)
    assert max(linear[1:]) / min(linear[1:]) < 1.2


def scenario(**values) -> Scenario:
    chosen = {"algorithm": "ftmcs", "topology": "all"} | {name.replace("__", "."): v for name, v in values.items()}
    return load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])


class Points:
    """Double integrators with the limits of a robot, each under the whole law, hearing what the others told last."""

    def __init__(self, s: Scenario, xs) -> None:
        self.s = s
        self.views = [robot_view(s, i) for i in range(s.robots)]
        self.laws = [ALGORITHMS[s.algorithm].controller(view) for view in self.views]
        self.xs, self.vs = np.array(xs, float), np.zeros((s.robots, 2))
        self.tick = 0
        self.nearest = math.inf
        self.farthest = 0.0  # of a virtual robot from its real one

    def run(self, plan_of, seconds: float) -> "Points":
        dt, body = self.s.timing.tick, msgspec.structs.replace(self.s.body, hand=1e-9)
        for _ in range(round(seconds / dt)):
            owns = []
            for i, (x, v) in enumerate(zip(self.xs, self.vs, strict=True)):
                own = Own(Reading(i, self.tick, self.tick * dt, x[0], x[1], 0.0, 0.0, 0.0, 1.0, 0.0, 0.0), body)
                own.vx, own.vy = float(v[0]), float(v[1])
                own.lever = 1.0  # a point can go sideways as well as forward
                owns.append(own)
            told = [
                Shared(o_i, self.tick, o.x, o.y, o.vx, o.vy, *(0.0,) * 7, 0, 0, *(0.0,) * 4, virtual=law.virtual())
                for o_i, (o, law) in enumerate(zip(owns, self.laws, strict=True))
            ]
            us = []
            for own, view, law in zip(owns, self.views, self.laws, strict=True):
                fresh = [(a, told[j]) for j, a in view.row]
                others = [(s.x, s.y, s.vx, s.vy) for s in told if s.robot != view.robot]
                us.append(law.control(own, fresh, others, plan_of(view.robot), dt))
            u = np.array(us)
            u *= np.minimum(1.0, 0.9 / np.maximum(np.linalg.norm(u, axis=1), 1e-9))[:, None]
            self.vs += dt * u
            self.vs *= np.minimum(1.0, 0.8 / np.maximum(np.linalg.norm(self.vs, axis=1), 1e-9))[:, None]
            self.xs += dt * self.vs
            self.tick += 1
            gaps = np.linalg.norm(self.xs[:, None] - self.xs[None], axis=2) + 1e9 * np.eye(len(self.xs))
            self.nearest = min(self.nearest, float(gaps.min()))
            hats = np.array([law.virtual()[:2] for law in self.laws])
            self.farthest = max(self.farthest, float(np.linalg.norm(hats - self.xs, axis=1).max()))
        return self


COLUMN = [(0, 0), (0.4, 3), (0, 6), (0.3, 9), (0, 12)]


@pytest.mark.parametrize("topology", ["all", "ring"])
def test_real_robots_take_the_distance_d_and_the_reference_velocity(topology):
    group = Points(scenario(topology=topology, ftmcs__reference="all"), COLUMN)
    group.run(lambda i: Plan(TRACE, (0.0, 0.0), v_c=(0.5, 0.1)), seconds=25.0)
    gaps = np.linalg.norm(group.xs[:, None] - group.xs[None], axis=2) + 1e9 * np.eye(5)
    heard = [min(gaps[i, j] for j, _ in view.row) for i, view in enumerate(group.views)]
    assert heard == pytest.approx([D] * 5, abs=0.1)
    assert np.abs(group.vs - (0.5, 0.1)).max() < 0.01
    assert group.nearest > 1.5


def test_group_circles_the_decided_source_at_the_radius_of_the_virtual_robot():
    group = Points(scenario(), [(30, 5), (33, 12), (28, 10), (31, 15), (26, 6)])
    plan = Plan(LOST, (20.0, 10.0), centre=(20.0, 10.0))
    group.run(lambda i: plan, seconds=40.0)
    p, t = group.s.ftmcs, group.tick * group.s.timing.tick
    leader = np.array((20.0, 10.0)) + p.circle * np.array((math.cos(p.turn * t), math.sin(p.turn * t)))
    assert np.linalg.norm(group.xs - leader, axis=1).max() < 2 * p.circle_d
    along = p.circle * p.turn * np.array((-math.sin(p.turn * t), math.cos(p.turn * t)))
    assert np.linalg.norm(group.vs.mean(axis=0) - along) < 0.05  # the ring of robots about it may still turn
    assert np.linalg.norm(group.vs - along, axis=1).max() < 0.15
    assert p.circle * p.turn < group.s.body.max_speed
    assert group.nearest > 0.4  # the virtual robot draws all to one place, and the nearer they come the less


@pytest.mark.parametrize(("centre", "at"), [("smelt", (0.0, 0.0)), ("decided", (20.0, 10.0))])
def test_a_lost_group_circles_where_the_odour_was_met_last_even_if_only_one_robot_met_it(centre, at):
    """On a line the place travels from neighbour to neighbour."""
    s = scenario(topology="line", ftmcs__centre=centre, ftmcs__circle=3.0, ftmcs__turn=0.1)
    group = Points(s, [(2, 3), (5, 3), (8, 3), (11, 3), (14, 3)])
    group.laws[0]._smell = (3.0, 0.0, 0.0)
    group.laws[3]._smell = (2.0, 90.0, 90.0)  # older
    group.run(lambda i: Plan(LOST, (20.0, 10.0), centre=(20.0, 10.0)), seconds=35.0)
    theta = s.ftmcs.turn * group.tick * s.timing.tick
    leader = np.array(at) + s.ftmcs.circle * np.array((math.cos(theta), math.sin(theta)))
    assert np.linalg.norm(group.xs.mean(axis=0) - leader) < 2.5


def test_virtual_robots_stay_on_the_leash_while_the_real_ones_cannot_follow():
    """v_c asks for more than the robots can do; without limits the virtual robots are far away after a while."""
    plan = Plan(TRACE, (0.0, 0.0), v_c=(2.0, 0.0))
    kept = Points(scenario(ftmcs__reference="all"), COLUMN).run(lambda i: plan, seconds=15.0)
    assert kept.farthest < kept.s.ftmcs.leash + 0.1
    loose = scenario(ftmcs__reference="all", ftmcs__leash=0.0, ftmcs__limited=False)
    assert Points(loose, COLUMN).run(lambda i: plan, seconds=15.0).farthest > 8.0


def test_the_robot_that_smelt_last_leads_and_the_others_take_its_velocity():
    """Everyone's v_c^i but the leader's points another way."""
    group = Points(scenario(), COLUMN)
    group.laws[2]._own_smell = 5.0
    group.laws[2]._smell = (5.0, 1.0, 2.0)
    told = {2: (0.6, 0.0)}
    group.run(lambda i: Plan(TRACE, (0.0, 0.0), v_c=told.get(i, (-0.6, 0.3))), seconds=18.0)
    assert np.abs(group.vs - (0.6, 0.0)).max() < 0.05


def test_a_robot_alone_follows_its_plan():
    group = Points(scenario(robots=2, topology="line"), [(0, 0), (30, 30)])
    group.views[0] = msgspec.structs.replace(group.views[0], row=())
    group.run(lambda i: Plan(SEARCH, (0.0, 0.0), v_c=(0.3, 0.2)), seconds=10.0)
    assert group.vs[0] == pytest.approx((0.3, 0.2), abs=0.01)


def test_virtual_state_travels_over_the_wire_from_the_second_tick_on():
    agent = Agent(robot_view(scenario(), 0))
    first = agent.sense(Reading(0, 0, 0.0, 5.0, 1.0, 0.2, 0.0, 0.0, 1.0, 0.0, 0.0))
    assert first.virtual == ()
    agent.act([])
    second = agent.sense(Reading(0, 1, 0.05, 5.0, 1.0, 0.2, 0.0, 0.0, 1.0, 0.0, 0.0))
    assert len(second.virtual) == 7
    assert math.hypot(second.virtual[0] - 5.0, second.virtual[1] - 1.0) < 0.3
    wire = Codec(7)
    assert wire.decode(wire.encode(second)) == second
