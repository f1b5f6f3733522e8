"""The finite-time consensus fusion (3.26): invariants, theory bands, chapter 3's Example 2."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol.scenario.sections import Fusion
from protocol.topology.named import build
from robot_agent import fusion


@dataclass
class Network:
    """All robots of a graph stepping at once, each with its own row only."""

    rows: list[list[tuple[int, float]]]
    parameters: Fusion

    def step(self, ys, inputs, dt):
        degree = max((sum(a for _, a in row) for row in self.rows), default=0.0)
        return [
            fusion.step(
                ys[i], [(a, *ys[j]) for j, a in row], None if inputs is None else inputs[i], self.parameters, degree, dt
            )
            for i, row in enumerate(self.rows)
        ]


def network(name: str, robots: int, **parameters) -> Network:
    graph = build(name, robots)
    rows = [[(j, a) for k, j, a in graph.edges if k == i] for i in range(robots)]
    return Network(rows, Fusion(**parameters))


starts = st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), min_size=5, max_size=5)


@given(ys=starts, topology=st.sampled_from(["all", "ring", "line", "star"]))
def test_linear_fusion_keeps_the_mean_without_input(ys, topology):
    net = network(topology, 5, beta=0.0)
    mean = np.mean(ys, axis=0)
    for _ in range(50):
        ys = net.step(ys, None, 0.05)
    assert np.mean(ys, axis=0) == pytest.approx(mean, abs=1e-9)


@given(value=st.floats(-50, 50), topology=st.sampled_from(["all", "ring"]))
def test_printed_fusion_keeps_the_mean_of_a_symmetric_start_without_input(value, topology):
    """The term in beta is odd, so what is symmetric about its mean stays so."""
    net = network(topology, 4)
    ys = [(value, 0.0), (1.0, 3.0), (-value, 0.0), (-1.0, -3.0)]
    for _ in range(50):
        ys = net.step(ys, None, 0.05)
    assert np.mean(ys, axis=0) == pytest.approx((0.0, 0.0), abs=1e-9)


def test_printed_fusion_moves_the_mean_of_an_uneven_start():
    """(3.26) applies sig to the sum over the neighbours: unlike its linear part it does not keep the mean."""
    net = network("star", 5)
    ys = [(10.0, 0.0)] + [(0.0, 0.0)] * 4
    for _ in range(200):
        ys = net.step(ys, None, 0.05)
    assert abs(np.mean(ys, axis=0)[0] - 2.0) > 0.3


@given(ys=starts, topology=st.sampled_from(["all", "ring", "line", "star"]))
def test_fusion_never_leaves_the_hull_and_agrees_without_input(ys, topology):
    net = network(topology, 5)
    low, high = np.min(ys, axis=0), np.max(ys, axis=0)
    for _ in range(400):
        ys = net.step(ys, None, 0.05)
        assert np.all(np.array(ys) >= low - 1e-9)
        assert np.all(np.array(ys) <= high + 1e-9)
    assert np.ptp(ys, axis=0).max() < 1e-3


@given(ys=starts)
@settings(max_examples=20)
def test_explicit_step_agrees_only_within_its_band_and_the_implicit_one_within_nothing(ys):
    """Forward Euler cycles in a band of order dt^(1/(1-a)) about agreement; the implicit step has none."""
    dt, a = 0.01, 0.5
    explicit, implicit = network("all", 5, step="explicit"), network("all", 5)
    es = ys
    for _ in range(1500):
        es, ys = explicit.step(es, None, dt), implicit.step(ys, None, dt)
    # phi cycles where beta sqrt(phi) dt N = 2 phi: phi = (beta dt N / 2)^2, and y spreads phi / N about the mean.
    band = (8.0 * dt * 5 / 2) ** (1 / (1 - a)) / 5
    assert np.ptp(es, axis=0).max() <= 10 * band
    assert np.ptp(ys, axis=0).max() < 1e-6


@pytest.mark.parametrize("beta", [0.0, 4.0, 8.0])
def test_fusion_tracks_a_moving_input_within_the_band_of_theory(beta):
    """Inputs r(t) = sin 2t: the error s obeys lambda s + beta (lambda s)^a <= nu = 2, sharper than Proposition 4."""
    net = network("fig-3.2", 4, beta=beta)
    dt, lam, nu = 0.002, 0.8, 2.0
    w = (-beta + math.sqrt(beta * beta + 4 * nu)) / 2  # root of w^2 + beta w = nu, w = sqrt(lambda s)
    bound = w * w / lam
    ys = [(0.0, 0.0)] * 4
    worst = 0.0
    for k in range(round(12 / dt)):
        r = math.sin(2 * k * dt)
        ys = net.step(ys, [(r, r)] * 4, dt)
        if k * dt > 4:
            worst = max(worst, *(abs(y[0] - math.sin(2 * (k + 1) * dt)) for y in ys))
    assert worst <= bound * 1.05 + 0.02
    if beta:
        assert worst > 0.3 * bound  # the band is not vacuous


def test_example_2_fusion_halves_the_noise():
    """Figure 3.3: fig-3.2, beta = 4, lambda = 0.8, a = 0.5, r = sin 2t, noise variance 0.3 drawn every 0.1 s."""
    net = network("fig-3.2", 4, beta=4.0)
    rng = np.random.default_rng(7)
    dt, hold = 0.002, 50
    ys = [(0.0, 0.0)] * 4
    fused, raw = [], []
    for k in range(6000):
        if k % hold == 0:
            noise = rng.normal(0, math.sqrt(0.3), (4, 2))
        r = math.sin(2 * k * dt)
        ys = net.step(ys, [tuple(r + n) for n in noise], dt)
        if k * dt > 2:
            truth = math.sin(2 * (k + 1) * dt)
            fused += [(y[0] - truth) ** 2 for y in ys]
            raw += list(noise[:, 0] ** 2)
    rms_fused, rms_raw = math.sqrt(np.mean(fused)), math.sqrt(np.mean(raw))
    assert rms_raw == pytest.approx(math.sqrt(0.3), rel=0.12)
    assert 0.24 < rms_fused < 0.34
    assert rms_fused < 0.6 * rms_raw
