"""Addressed bulk noise."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world_server.noise import StepNoise, generator_for


@given(st.integers(0, 2**63 - 1), st.integers(0, 2**64 - 1))
def test_a_step_draws_the_same_as_when_built_afresh_whatever_was_drawn_before(seed: int, k: int) -> None:
    used = StepNoise(seed, "wind")
    rng = used.at(3)
    rng.standard_normal(7)
    rng.random(dtype=np.float32)  # leaves half of a 64-bit word behind
    assert used.at(k).random(5, dtype=np.float32).tolist() == (
        StepNoise(seed, "wind").at(k).random(5, dtype=np.float32).tolist()
    )
    rng.poisson(3.0)
    assert used.at(k).standard_normal(20).tolist() == StepNoise(seed, "wind").at(k).standard_normal(20).tolist()


def test_step_zero_is_the_stream_of_the_generator_with_the_same_address() -> None:
    stepped, plain = StepNoise(5, "a", 1).at(0), generator_for(5, "a", 1)
    for n in (1, 3, 8):  # half-used 64-bit words and buffers between the draws
        assert stepped.random(n, dtype=np.float32).tolist() == plain.random(n, dtype=np.float32).tolist()
        assert stepped.random(n).tolist() == plain.random(n).tolist()


@pytest.mark.parametrize("other", [(6, "a", 1), (5, "b", 1), (5, "a", 2), (5, "a"), (5, "a", "1")])
def test_another_address_is_another_stream(other: tuple[int | str, ...]) -> None:
    seed, *address = other
    assert isinstance(seed, int)
    assert generator_for(5, "a", 1).random(4).tolist() != generator_for(seed, *address).random(4).tolist()


def test_neighbouring_steps_share_no_draw_and_are_uncorrelated() -> None:
    noise = StepNoise(1, "plume")
    n = 20_000
    a, b = noise.at(7).standard_normal(n), noise.at(8).standard_normal(n)
    assert not set(a.tolist()) & set(b.tolist())
    assert abs(np.mean(a * b)) < 5.0 / np.sqrt(n)
    assert abs(np.mean(a[1:] * b[:-1])) < 5.0 / np.sqrt(n)


def test_draws_over_many_steps_are_standard_normal() -> None:
    noise = StepNoise(2, "plume")
    firsts = np.array([noise.at(k).standard_normal() for k in range(20_000)])
    n = firsts.size
    assert abs(firsts.mean()) < 5.0 / np.sqrt(n)
    assert abs(firsts.var() - 1.0) < 5.0 * np.sqrt(2.0 / n)
