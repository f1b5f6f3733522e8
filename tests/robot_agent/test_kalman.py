"""The intermittent Kalman filter against one batch least-squares solve, and chapter 3's Example 1."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.kalman import Estimate, model_noise, predict, printed_noise, update

arrivals = st.lists(
    st.tuples(st.booleans(), st.floats(-100, 100), st.floats(-100, 100), st.floats(0.1, 100)), min_size=1, max_size=30
)


def batch(prior: Estimate, steps, q: float) -> tuple[float, float, float]:
    """Final state and variance by one weighted least-squares solve over the whole history x_0 .. x_n."""
    n = len(steps) + 1 if q > 0 else 1
    rows, rhs = [], []

    def equation(coefficients, values, variance):
        row = np.zeros(n)
        for index, value in coefficients:
            row[index] = value
        rows.append(row / math.sqrt(variance))
        rhs.append(np.array(values) / math.sqrt(variance))

    equation([(0, 1.0)], (prior.x, prior.y), prior.P)
    for k, (arrived, zx, zy, R) in enumerate(steps, start=1):
        state = k if q > 0 else 0
        if q > 0:
            equation([(state, 1.0), (state - 1, -1.0)], (0.0, 0.0), q)
        if arrived:
            equation([(state, 1.0)], (zx, zy), R)
    A, b = np.array(rows), np.array(rhs)
    information = A.T @ A
    x = np.linalg.solve(information, A.T @ b)
    return x[-1, 0], x[-1, 1], np.linalg.inv(information)[-1, -1]


@given(steps=arrivals, q=st.sampled_from([0.0, 0.5, 20.0]))
def test_filter_equals_batch_posterior_for_any_arrival_pattern(steps, q):
    prior = estimate = Estimate(5.0, -3.0, 50.0)
    for arrived, zx, zy, R in steps:
        estimate = update(predict(estimate, q), (zx, zy) if arrived else None, R)
    x, y, P = batch(prior, steps, q)
    assert estimate.x == pytest.approx(x, rel=1e-6, abs=1e-6)
    assert estimate.y == pytest.approx(y, rel=1e-6, abs=1e-6)
    assert estimate.P == pytest.approx(P, rel=1e-6)


@given(steps=arrivals)
def test_variance_never_grows_without_process_noise_and_stays_positive(steps):
    estimate = Estimate(0.0, 0.0, 1000.0)
    for arrived, zx, zy, R in steps:
        after = update(predict(estimate, 0.0), (zx, zy) if arrived else None, R)
        assert 0.0 < after.P <= estimate.P
        estimate = after


@pytest.mark.parametrize(("arrival", "thesis_order"), [(0.9, 1), (0.5, 2), (0.1, 3)])
def test_example_1_error_shrinks_with_the_probability_of_arrival(arrival, thesis_order):
    """Figure 3.1: R_0 = 2.1, true measurement variance 2.1 + 10.3, P(0) = 1000, x_hat(0) = 0.

    The true error after k steps is sqrt(12.4 / (p k)), 2.4 times what the filter's own P claims.
    """
    rng = np.random.default_rng(thesis_order)
    runs, steps = 400, 100
    errors, claims = [], []
    for _ in range(runs):
        estimate = Estimate(0.0, 0.0, 1e3)
        for _ in range(steps):
            z = None
            if rng.random() < arrival:
                z = tuple(5.0 + rng.normal(0.0, math.sqrt(12.4), 2))
            estimate = update(predict(estimate, 0.0), z, 2.1)
        errors.append((estimate.x - 5.0) ** 2)
        errors.append((estimate.y - 5.0) ** 2)
        claims.append(estimate.P)
    rms = math.sqrt(np.mean(errors))
    # E[1/n] over the binomial number of arrivals n is a little above 1/(p k).
    counts = rng.binomial(steps, arrival, 20000)
    expected = math.sqrt(12.4 * np.mean(1.0 / np.maximum(counts, 1)))
    assert rms == pytest.approx(expected, rel=0.12)
    assert rms / math.sqrt(np.mean(claims)) == pytest.approx(math.sqrt(12.4 / 2.1), rel=0.12)


def test_model_noise_is_the_mean_of_the_lags():
    for k in (1, 2, 10, 99):
        assert model_noise(2.1, k) == pytest.approx(sum((k - lag) * 2.1 for lag in range(k)) / k)


def test_printed_noise_grows_like_a_factorial():
    R = 2.1
    for k in range(1, 51):
        R = printed_noise(R, k)
    assert R > 1e45
    assert printed_noise(1e300, 100.0) == 1e300
