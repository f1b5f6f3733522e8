"""Addressed randomness: a draw depends on its name and on nothing else."""

import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from protocol.randomness import key_for, rng_for

WORDS = st.sampled_from(["link", "wind", "1", "", "a"])
ADDRESSES = st.lists(st.one_of(st.integers(-(10**6), 10**6), WORDS), max_size=4)
DRAWS = 20_000
# Kolmogorov's statistic times sqrt(n) is above this in one of a million runs; the draws are fixed, so it is no lottery.
KOLMOGOROV = 2.7


@given(st.integers(0, 2**63), ADDRESSES, st.integers(0, 2**63), ADDRESSES)
def test_different_addresses_have_different_keys(seed_1: int, one: list, seed_2: int, other: list) -> None:
    same = (seed_1, *map(repr, one)) == (seed_2, *map(repr, other))
    assert (key_for(seed_1, *one) == key_for(seed_2, *other)) == same


def test_a_number_and_its_digits_are_different_addresses() -> None:
    keys = {key_for(1, 2, 3), key_for(1, "2", 3), key_for(1, 2, "3"), key_for(1, "23"), key_for(1, 23), key_for(12, 3)}
    assert len(keys) == 6


@given(st.permutations(range(6)), st.data())
def test_a_draw_does_not_depend_on_who_drew_before(order: list[int], data: st.DataObject) -> None:
    alone = [[rng.uniform() for _ in range(3)] for rng in (rng_for(7, "robot", i) for i in range(6))]
    streams = [rng_for(7, "robot", i) for i in range(6)]
    turns = [i for i in order for _ in range(3)]
    random.Random(data.draw(st.integers(0, 99))).shuffle(turns)
    mixed: list[list[float]] = [[] for _ in streams]
    for i in turns:
        mixed[i].append(streams[i].uniform())
    assert mixed == alone


def test_uniform_draws_are_uniform_along_a_stream_and_across_addresses() -> None:
    stream = rng_for(1, "stream")
    along = [stream.uniform() for _ in range(DRAWS)]
    across = [rng_for(1, "link", k % 7, k % 5, k).uniform() for k in range(DRAWS)]
    for draws in (along, across):
        assert all(0.0 <= u < 1.0 for u in draws)
        assert stats.kstest(draws, "uniform").statistic * math.sqrt(DRAWS) < KOLMOGOROV


def test_normal_draws_are_normal() -> None:
    stream = rng_for(2, "noise")
    draws = [stream.normal() for _ in range(DRAWS)]
    assert stats.kstest(draws, "norm").statistic * math.sqrt(DRAWS) < KOLMOGOROV


@pytest.mark.parametrize("lag", [1, 2, 5])
def test_neighbouring_addresses_and_draws_are_uncorrelated(lag: int) -> None:
    stream = rng_for(3, "stream")
    along = [stream.uniform() for _ in range(DRAWS)]
    across = [rng_for(3, "tick", k).uniform() for k in range(DRAWS)]
    for draws in (along, across):
        r = stats.pearsonr(draws[:-lag], draws[lag:]).statistic
        assert abs(r) * math.sqrt(DRAWS) < 5.0  # about normal with variance 1 when there is no correlation


def test_draws_stay_what_they_are_on_every_machine() -> None:
    """Recorded runs and digests hang on these; they may not change."""
    rng = rng_for(1, "link", 2, 3, 4)
    golden = ["0x1.6d24e77bbb2b4p-3", "0x1.00895598353e5p-1", "0x1.b999f2cfb25bbp-1"]
    assert [rng.uniform().hex() for _ in range(3)] == golden
    assert rng_for(1, "link", 2, 3, 4).normal() == pytest.approx(-0.6266784497866913, rel=1e-15)
    assert key_for(1, "wind") == 321017333902931143986284000355467574094
