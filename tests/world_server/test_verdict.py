"""Who found the source first, exactly when, and how near the robots came to each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from protocol.scenario.sections import Body, Source, Timing
from world_server.bodies import Bodies, Path
from world_server.verdict import Found, Verdict, first_arrival

Array = NDArray[np.float64]
SOURCE = Source(x=10.0, y=0.0, radius=1.0)


def path_of(*robots: list[complex], h: float = 0.01) -> Path:
    """A tick in which the hands go through the given points."""
    track = np.array(robots, dtype=np.complex128)
    return Path(track.tolist(), np.abs(np.diff(track, axis=1)).sum(axis=1).tolist(), h)


def start_of(path: Path) -> Array:
    """Where the hands are when `path` begins, (N, 2)."""
    return np.column_stack([path.track[:, 0].real, path.track[:, 0].imag])


def judged(path: Path, t0: float = 5.0) -> Verdict:
    verdict = Verdict(SOURCE, start_of(path))
    verdict.judge(path, t0)
    return verdict


def test_arrival_is_where_the_way_enters_the_circle_between_substeps() -> None:
    found = judged(path_of([13.0, 12.0, 11.2, 10.7, 10.5])).found
    assert found is not None
    assert found.robot == 0
    assert found.t == pytest.approx(5.0 + 0.01 * (2 + 0.2 / 0.5))


def test_a_way_through_the_circle_counts_even_when_no_substep_ends_inside() -> None:
    found = judged(path_of([12.0 + 0.6j, 8.0 + 0.6j])).found
    assert found is not None
    assert found.t == pytest.approx(5.0 + 0.01 * (12.0 - 10.8) / 4.0)


def test_a_way_past_the_circle_does_not_count() -> None:
    verdict = judged(path_of([12.0 + 1.001j, 8.0 + 1.001j]))
    assert verdict.found is None


def test_the_first_robot_to_enter_finds_even_when_another_gets_deeper() -> None:
    found = judged(path_of([12.0, 11.5, 10.0], [8.5, 9.1, 9.2], [50.0, 50.0, 50.0])).found
    assert found is not None
    assert found.robot == 1
    assert found.t == pytest.approx(5.0 + 0.01 * 0.5 / 0.6)


def test_of_two_that_enter_together_the_lower_number_finds() -> None:
    found = judged(path_of([50.0, 50.0], [8.0, 10.0], [12.0, 10.0])).found
    assert found == Found(1, 5.0 + 0.01 * 0.5)


def test_a_robot_that_starts_at_the_source_has_found_it_at_time_zero() -> None:
    assert Verdict(SOURCE, np.array([[50.0, 0.0], [10.5, 0.5]])).found == Found(1, 0.0)


def test_the_finder_stays_when_others_come_later() -> None:
    verdict = judged(path_of([12.0, 10.5], [50.0, 50.0]))
    first = verdict.found
    verdict.judge(path_of([10.5, 30.0], [9.0, 10.0]), 5.01)
    assert first is not None
    assert verdict.found == first


@given(
    p=st.complex_numbers(min_magnitude=1.01, max_magnitude=4.0),
    q=st.complex_numbers(max_magnitude=4.0),
)
def test_entry_agrees_with_a_fine_walk_along_the_way(p: complex, q: complex) -> None:
    found = judged(path_of([10.0 + p, 10.0 + q], h=1.0), t0=0.0).found
    fine = np.abs(p + (q - p) * np.linspace(0.0, 1.0, 4001))
    inside = np.flatnonzero(fine <= 1.0)
    if inside.size:
        assert found is not None
        assert abs(found.t - inside[0] / 4000) <= 1 / 4000 + 1e-9
    elif fine.min() > 1.0 + 1e-5:
        assert found is None


def test_a_driven_robot_finds_at_a_time_that_does_not_hang_on_tick_or_substep() -> None:
    times = []
    for tick, substep in ((0.05, 0.01), (0.25, 0.05), (0.01, 0.01)):
        bodies = Bodies(Body(), Timing(tick=tick, substep=substep), [7.0], [0.3], [0.0])
        verdict = Verdict(SOURCE, bodies.hands())
        for k in range(round(10.0 / tick)):
            verdict.judge(bodies.step([0.2], [0.2]), k * tick)
        assert verdict.found is not None
        times.append(verdict.found.t)
    a = Body().wheel_radius * 0.2 / Body().wheel_inertia
    way = 3.0 - math.sqrt(1.0 - 0.09) - 0.12
    t_full = 0.8 / a  # when it has reached its greatest speed
    exact = t_full + (way - 0.4 * t_full) / 0.8
    assert times == pytest.approx([exact] * 3, abs=2e-3)


@settings(deadline=None)
@given(seed=st.integers(0, 10**6), robots=st.integers(1, 4))
def test_looking_only_when_it_can_matter_finds_the_arrival_that_looking_always_finds(seed: int, robots: int) -> None:
    rng = np.random.default_rng(seed)
    places = rng.uniform(-4.0, 4.0, (robots, 2)).view(np.complex128) + 10.0
    verdict = Verdict(SOURCE, np.ascontiguousarray(places).view(np.float64))
    expected = first_arrival(places, 10.0 + 0.0j, 1.0, 0.0, 0.0)
    for k in range(40):
        steps = 0.15 * rng.normal(size=(robots, 3, 2)).view(np.complex128)[:, :, 0]
        track = np.hstack([places, places + np.cumsum(steps, axis=1)])
        path = path_of(*track.tolist())
        verdict.judge(path, 0.05 * k)
        if expected is None:
            expected = first_arrival(track, 10.0 + 0.0j, 1.0, 0.05 * k, path.h)
        places = track[:, -1:]
    assert verdict.found == expected


@settings(deadline=None)
@given(seed=st.integers(0, 10**6), robots=st.integers(2, 7), stride=st.floats(0.001, 2.0))
def test_distances_are_the_smallest_over_all_substeps_of_all_ticks(seed: int, robots: int, stride: float) -> None:
    rng = np.random.default_rng(seed)
    places = rng.uniform(20.0, 30.0, (robots, 2)).view(np.complex128)
    verdict = Verdict(SOURCE, np.ascontiguousarray(places).view(np.float64))
    pairs = [abs(places[i, 0] - places[j, 0]) for i in range(robots) for j in range(i)]
    for k in range(6):
        steps = stride * rng.normal(size=(robots, 4, 2)).view(np.complex128)[:, :, 0]
        track = np.hstack([places, places + np.cumsum(steps, axis=1)])
        verdict.judge(path_of(*track.tolist()), 0.05 * k)
        pairs += [np.abs(track[i] - track[j]).min() for i in range(robots) for j in range(i)]
        places = track[:, -1:]
    assert verdict.min_pair_distance == pytest.approx(min(pairs), rel=1e-12)


def test_a_lone_robot_has_no_pair() -> None:
    assert Verdict(SOURCE, np.array([[50.0, 0.0]])).min_pair_distance is None
