"""Chapter 3's examples: the filter against a mean, the fusion against its linear answer and bound, parallel movement."""

from __future__ import annotations

import math

import numpy as np
import pytest

from deploy.reproduce.chapter3 import filtering
from deploy.reproduce.chapter3.fusing import SETTLED, bound, follow, lag
from deploy.reproduce.chapter3.parallel import SECONDS, V_C, agreed, move


@pytest.mark.parametrize("arrival", filtering.ARRIVALS)
def test_the_filter_is_as_good_as_a_mean_and_thinks_itself_better(arrival: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(filtering, "RUNS", 60)
    off, own = filtering.errors(0, arrival)
    rms = math.sqrt((off[:, -1] ** 2).mean())
    mean = math.sqrt((filtering.KNOWN + filtering.UNKNOWN) / (arrival * filtering.STEPS))
    # 120 samples: a relative standard error of 1/sqrt(240), and more where the number that arrives varies
    assert rms == pytest.approx(mean, rel=0.3)
    assert math.sqrt(own[:, -1].mean()) < 0.6 * rms


def test_the_linear_fusion_lags_as_a_filter_of_first_order_does() -> None:
    # beta = 0: y' = lambda (sin 2t - y), whose error has the amplitude |2i / (2i + lambda)|
    assert lag(0.0) == pytest.approx(2.0 / math.hypot(2.0, 0.8), rel=0.01)


def test_a_larger_beta_follows_better_and_within_the_bound() -> None:
    errors = [lag(beta) for beta in (0.0, 4.0, 8.0)]
    assert errors == sorted(errors, reverse=True)
    assert 2.0 * errors[1] < bound(4.0)
    assert bound(8.0) < bound(4.0) < bound(0.0)


def test_fused_data_are_less_noisy_than_what_is_measured() -> None:
    t, u, y = follow(4.0, seed=1)
    late = t >= SETTLED
    raw, fused = (np.sqrt(((values - np.sin(2 * t)[:, None])[late] ** 2).mean()) for values in (u, y))
    assert fused < 0.7 * raw
    assert raw == pytest.approx(math.sqrt(0.3), rel=0.15)


def test_with_the_potential_added_the_group_comes_to_move_in_parallel() -> None:
    places, velocities = move(3, "sum")
    assert agreed(velocities, 0.05) < SECONDS
    assert np.linalg.norm(places[-1] - places[-41], axis=1) == pytest.approx(np.full(3, math.hypot(*V_C)), rel=0.01)


def test_with_the_potential_in_its_place_a_group_near_each_other_never_does() -> None:
    ends = [agreed(move(seed, "switch")[1], 0.05) for seed in range(6)]
    assert any(math.isinf(end) for end in ends)
