"""Chapter 5: the laws against the printed formulas, the exercises on whole swarms, and keeping clear in a crowd."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deploy.memory_run import MemorySwarm, run_in_memory
from protocol.scenario import Scenario
from protocol.scenario.load import load_scenario
from robot_agent.algorithms import ALGORITHMS
from robot_agent.control.consensus_laws import (
    Motion,
    agreement,
    circular,
    formation,
    orbit,
    parallel,
    relative,
    respond,
)
from robot_agent.sig import explicit_step

number = st.floats(-20, 20)
motion = st.builds(Motion, number, number, number, number)
gain = st.floats(0.05, 5)


def sig(x: np.ndarray, alpha: float) -> np.ndarray:
    return np.sign(x) * np.abs(x) ** alpha


@st.composite
def swarms(draw):
    """Motions of N robots and a weighted graph, undirected or not, connected or not."""
    n = draw(st.integers(1, 4))
    motions = [draw(motion) for _ in range(n)]
    a = np.array([[0.0 if i == j else draw(st.sampled_from([0.0, 0.5, 1.0, 2.0])) for j in range(n)] for i in range(n)])
    return motions, a


def printed_sum(xs, vs, a, beta, gamma):
    """sum_j a_ij (beta (x_j - x_i) + gamma (v_j - v_i)) for all i, with matrices."""
    ell = np.diag(a.sum(axis=1)) - a
    return -beta * ell @ xs - gamma * ell @ vs


@given(swarms(), gain, gain, gain, gain, st.floats(0.2, 0.9), st.tuples(number, number), st.floats(-3, 3))
@settings(max_examples=60, deadline=None)
def test_the_laws_are_the_printed_formulas(swarm, beta, gamma, lam1, lam2, alpha, given_point, t):
    motions, a = swarm
    n = len(motions)
    xs, vs = np.array([m[:2] for m in motions]), np.array([m[2:] for m in motions])
    h = np.array(formation(5.0, n, n))
    orbits = np.array([orbit(4.0, 0.3, 2 * math.pi * (i + 1) / n + 0.3 * t) for i in range(n)])
    o, o_dot = orbits[:, 0], orbits[:, 1]
    point = np.array(given_point)
    printed = {
        "(5.1)": printed_sum(xs, vs, a, beta, gamma),
        "(5.4)": printed_sum(xs - h, vs, a, beta, gamma) + lam1 * (point - vs),
        "(5.6)": printed_sum(xs - o, vs - o_dot, a, beta, gamma) + lam1 * (o_dot - vs) + lam2 * (point - (xs - o)),
    }
    for i in range(n):
        still = [(a[i, j], relative(motions[j], tuple(h[j]))) for j in range(n)]
        moving = [(a[i, j], relative(motions[j], tuple(o[j]), tuple(o_dot[j]))) for j in range(n)]
        ours = {
            "(5.1)": agreement(motions[i], [(a[i, j], motions[j]) for j in range(n)], beta, gamma),
            "(5.4)": parallel(still[i][1], still, given_point, beta, gamma, lam1),
            "(5.6)": circular(moving[i][1], moving, given_point, beta, gamma, lam1, lam2),
        }
        for name, phi in ours.items():
            assert phi == pytest.approx(tuple(printed[name][i]), rel=1e-9, abs=1e-9), name
            u = np.array(phi) + sig(np.array(phi), alpha)  # of our phi: sig makes much of a rounding near 0
            assert respond(phi, alpha, explicit_step, 0.0) == pytest.approx(tuple(u), rel=1e-12)


def test_a_place_on_a_circle_moves_as_its_rates_say():
    (x, y), (vx, vy) = orbit(7.0, 0.4, 1.1)
    (x1, y1), _ = orbit(7.0, 0.4, 1.1 + 0.4 * 1e-6)
    assert ((x1 - x) / 1e-6, (y1 - y) / 1e-6) == pytest.approx((vx, vy), rel=1e-5)
    assert math.hypot(x, y) == pytest.approx(7.0)


def drill(algorithm: str, **values: object) -> Scenario:
    chosen: dict[str, object] = {"algorithm": algorithm, "plume.release_rate": 0.0, "sensors.wind_history": 0.0}
    chosen |= {name.replace("__", "."): value for name, value in values.items()}
    return load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])


def run(scenario: Scenario):
    """Outcome, hand positions and velocities at the end."""
    swarms: list[MemorySwarm] = []
    outcome = run_in_memory(scenario, observe=lambda swarm: swarms.append(swarm) is None)
    bodies = swarms[0].session.world.bodies
    theta, nu, omega, length = bodies.theta, bodies.nu, bodies.omega, scenario.body.hand
    c, s = np.cos(theta), np.sin(theta)
    return outcome, bodies.hands(), np.stack([nu * c - length * omega * s, nu * s + length * omega * c], axis=1)


@pytest.mark.parametrize("topology", ["line", "ring"])
def test_parallel_robots_come_to_formation_and_velocity_and_have_no_estimate(topology):
    s = drill("parallel", topology=topology, robots=3, max_time=100.0)
    outcome, xs, vs = run(s)
    assert np.ptp(xs - formation(s.drill.radius, 3, 3), axis=0).max() < 0.05
    assert np.abs(vs - s.drill.velocity).max() < 0.02
    assert (outcome.found, outcome.ended, outcome.failed) == (False, "time out", False)
    assert outcome.estimate_error == (None, None, None)


def test_formation_robots_agree_on_a_velocity_that_nobody_gave_them():
    s = drill("formation", topology="line", robots=4, max_time=150.0)
    _, xs, vs = run(s)
    assert np.ptp(xs - formation(s.drill.radius, 4, 4), axis=0).max() < 0.05
    assert np.ptp(vs, axis=0).max() < 0.01


def test_consensus_robots_gather_without_touching():
    s = drill("consensus", topology="line", robots=4, start__spacing=8.0, max_time=60.0)
    outcome, xs, vs = run(s)
    assert np.linalg.norm(xs - xs.mean(axis=0), axis=1).max() < 4.0
    assert np.linalg.norm(vs, axis=1).max() < 0.3
    assert outcome.min_pair_distance > 0.4


def test_circular_robots_circle_at_their_own_radii():
    s = drill("circular", topology="line", robots=3, drill__radii=(3.0, 8.0, 12.0), drill__turn=0.05,
              drill__centre=(80.0, -30.0), max_time=80.0)  # fmt: skip
    _, xs, vs = run(s)
    assert np.linalg.norm(xs - s.drill.centre, axis=1) == pytest.approx(s.drill.radii, abs=0.02)
    assert np.linalg.norm(vs, axis=1) == pytest.approx([0.05 * r for r in s.drill.radii], abs=0.005)


def test_the_others_go_on_when_a_robot_dies():
    s = drill("parallel", topology="ring", robots=4, max_time=80.0)
    swarm = MemorySwarm(s)
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
        if swarm.session.world.tick == 100:
            swarm.kill(1)
    alive = [0, 2, 3]
    xs = swarm.session.world.bodies.hands() - formation(s.drill.radius, 4, 4)
    assert np.ptp(xs[alive], axis=0).max() < 0.1
    assert swarm.session.ended == "time out"


@pytest.mark.parametrize(("algorithm", "topology", "robots"), [("consensus", "star", 8), ("formation", "star", 12)])
def test_a_crowd_keeps_apart(algorithm, topology, robots):
    outcome, _, _ = run(drill(algorithm, topology=topology, robots=robots, max_time=25.0))
    assert outcome.min_pair_distance > 0.4


def test_exercises_say_that_they_are_ones():
    assert {"consensus", "formation", "parallel", "circular"} <= {name for name, p in ALGORITHMS.items() if p.drill}
    assert not any(ALGORITHMS[name].drill for name in ("dcs", "cfpso", "simple"))
    assert all(parts.at_once for parts in ALGORITHMS.values() if parts.drill)
