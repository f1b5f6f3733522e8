"""The corner noise is the exact stationary process, whatever the step."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import expm

from world_server.coloured_noise import ColouredNoise, deviation, transition

Array = NDArray[np.float64]
bandwidths = st.floats(0.01, 5.0)
dampings = st.floats(0.01, 0.99)
steps = st.floats(0.01, 2.0)


def by_matrix_exponential(w: float, zeta: float, dt: float) -> tuple[Array, Array]:
    """Phi and Q in the units (x / sigma, x' / (w sigma)), by Van Loan's block exponential."""
    a = np.array([[0.0, w], [-w, -2.0 * zeta * w]])
    noise = np.array([[0.0, 0.0], [0.0, 4.0 * zeta * w]])  # keeps the identity stationary: A + A^T + noise = 0
    block = expm(np.block([[-a, noise], [np.zeros((2, 2)), a.T]]) * dt)
    phi = block[2:, 2:].T
    return phi, phi @ block[:2, 2:]


@given(bandwidths, dampings, steps)
def test_transition_equals_the_matrix_exponential(w: float, zeta: float, dt: float) -> None:
    phi, root = transition(w, zeta, dt)
    phi_slow, q_slow = by_matrix_exponential(w, zeta, dt)
    np.testing.assert_allclose(phi, phi_slow, atol=1e-9)
    np.testing.assert_allclose(root @ root.T, q_slow, atol=1e-8)  # the reference cancels to about 1e-9


@given(bandwidths, dampings, steps)
def test_two_half_steps_are_one_step_in_law(w: float, zeta: float, dt: float) -> None:
    phi, root = transition(w, zeta, dt)
    half, half_root = transition(w, zeta, dt / 2)
    q_half = half_root @ half_root.T
    np.testing.assert_allclose(half @ half, phi, atol=1e-12)
    np.testing.assert_allclose(half @ q_half @ half.T + q_half, root @ root.T, atol=1e-12)


@given(bandwidths, dampings, st.floats(1e-9, 1e3))
def test_the_stationary_covariance_stays_for_any_step(w: float, zeta: float, dt: float) -> None:
    phi, root = transition(w, zeta, dt)
    # Q[0, 0] of order tau^3 may round to 0 and takes Q[1, 0] of order tau^2 along: eps^(2/3) = 4e-11.
    np.testing.assert_allclose(phi @ phi.T + root @ root.T, np.eye(2), atol=1e-10)


@pytest.mark.parametrize("dt", [0.05, 0.1, 0.5])
def test_variance_and_autocovariance_match_theory_for_every_step(dt: float) -> None:
    gain, w, zeta, count = 1.5, 0.2, 0.1, 6000
    noise = ColouredNoise(gain, w, zeta, dt, count, 11, "test")
    sigma = deviation(gain, w, zeta)
    assert sigma == pytest.approx(gain * math.sqrt(0.5))
    band = 5.0 * math.sqrt(2.0 / count)  # five standard errors of a variance
    start = noise.values()
    assert np.var(start) / sigma**2 == pytest.approx(1.0, abs=band)
    lag = 4.0
    for k in range(round(lag / dt)):
        noise.advance(k)
    end = noise.values()
    assert np.var(end) / sigma**2 == pytest.approx(1.0, abs=band)
    root = math.sqrt(1 - zeta**2)
    theory = math.exp(-zeta * w * lag) * (math.cos(root * w * lag) + zeta / root * math.sin(root * w * lag))
    assert np.mean(start * end) / sigma**2 == pytest.approx(theory, abs=band)


def test_without_gain_there_is_no_noise() -> None:
    noise = ColouredNoise(0.0, 0.2, 0.1, 0.1, 8, 1, "test")
    noise.advance(0)
    assert noise.values().tolist() == [0.0] * 8
