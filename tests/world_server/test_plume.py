"""The plume: bookkeeping, statistics that do not hang on the step, concentration against a direct sum."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from protocol.scenario.sections import Arena, Source, Wind
from protocol.scenario.sections import Plume as PlumeTable
from world_server.growth import radius_at
from world_server.plume import Plume
from world_server.wind import WindField

Array = NDArray[np.float64]


def blow(plume: Plume, wind: WindField, seconds: float) -> None:
    """Step both, wind first, as the world does."""
    for _ in range(round(seconds / wind.dt)):
        wind.advance()
        plume.advance(wind)


def ages_of(plume: Plume, dt: float) -> Array:
    """Ages of the living filaments, s."""
    return plume.step * dt - plume._births[: plume.alive]


def test_filaments_released_are_alive_or_have_left_at_every_step() -> None:
    wind = WindField(Wind(speed=2.0, gain=2.0), Arena(), 3)
    plume = Plume(PlumeTable(release_rate=40.0), Source(x=60.0), Arena(), 3)
    for _ in range(1500):
        wind.advance()
        plume.advance(wind)
        assert plume.released == plume.alive + plume.left
        x, y = plume.positions
        assert np.all((x >= -5) & (x <= 105) & (y >= -55) & (y <= 55))
        assert np.all(ages_of(plume, wind.dt) >= 0.0)
    assert plume.left > 1000
    assert plume.alive > 100


def test_no_filament_is_lost_or_doubled_when_others_leave() -> None:
    """Each filament keeps its own birth: in a steady wind its place tells its age."""
    wind = WindField(Wind(gain=0.0), Arena(), 1)
    plume = Plume(PlumeTable(dispersion=0.0, release_rate=30.0), Source(), Arena(), 1)
    blow(plume, wind, 150.0)
    assert plume.left > 1000
    np.testing.assert_allclose(plume.positions[0], 10.0 + ages_of(plume, wind.dt), atol=1e-9)
    np.testing.assert_allclose(plume.positions[1], 0.0, atol=1e-9)
    assert np.unique(plume._births[: plume.alive]).size == plume.alive
    assert plume.positions[0].max() > 104.0


def test_a_source_without_release_makes_no_plume() -> None:
    wind = WindField(Wind(), Arena(), 1)
    plume = Plume(PlumeTable(release_rate=0.0), Source(), Arena(), 1)
    blow(plume, wind, 5.0)
    assert (plume.released, plume.alive) == (0, 0)
    assert plume.concentration([10.0, 20.0], [0.0, 0.0]).tolist() == [0.0, 0.0]
    assert plume.snapshot().shape == (0, 3)


@pytest.mark.parametrize("dt", [0.2, 0.1, 0.05])
def test_count_and_spread_match_theory_for_every_step(dt: float) -> None:
    """In a steady wind:  count ~ Poisson(rate T),  y ~ N(0, sigma^2 age),  x - x_s - u age ~ N(0, sigma^2 age)."""
    rate, sigma, seconds = 60.0, 0.2, 60.0
    wind = WindField(Wind(gain=0.0, dt=dt), Arena(), 1)
    plume = Plume(PlumeTable(release_rate=rate, dispersion=sigma), Source(), Arena(), 17)
    blow(plume, wind, seconds)
    expected = rate * seconds
    assert abs(plume.released - expected) < 5.0 * math.sqrt(expected)
    assert plume.left == 0
    n, ages = plume.alive, ages_of(plume, dt)
    x, y = plume.positions
    for offset in (y, x - 10.0 - ages):
        standard = offset / (sigma * np.sqrt(ages))
        assert abs(standard.mean()) < 5.0 / math.sqrt(n)
        assert abs(standard.var() - 1.0) < 5.0 * math.sqrt(2.0 / n)


def test_a_filament_moves_and_spreads_for_the_part_of_its_first_step_that_it_lived() -> None:
    sigma, dt = 0.2, 1.0
    wind = WindField(Wind(gain=0.0, dt=dt), Arena(), 1)
    standard = []
    for seed in range(5):
        plume = Plume(PlumeTable(release_rate=1000.0, dispersion=sigma), Source(), Arena(), seed)
        plume.advance(wind)
        ages, (x, y) = ages_of(plume, dt), plume.positions
        standard += [y / (sigma * np.sqrt(ages)), (x - 10.0 - ages) / (sigma * np.sqrt(ages))]
    every = np.concatenate(standard)
    assert abs(every.mean()) < 5.0 / math.sqrt(every.size)
    assert abs(every.var() - 1.0) < 5.0 * math.sqrt(2.0 / every.size)


@pytest.mark.parametrize("dt", [1.0, 0.1])
def test_releases_are_spread_evenly_over_the_step(dt: float) -> None:
    wind = WindField(Wind(gain=0.0, dt=dt), Arena(), 1)
    plume = Plume(PlumeTable(release_rate=100.0, dispersion=0.0), Source(), Arena(), 5)
    blow(plume, wind, 50.0)
    part = np.sort((ages_of(plume, dt) / dt) % 1.0)
    n = part.size
    gap = np.abs(part - (np.arange(n) + 0.5) / n).max()
    assert gap < 1.95 / math.sqrt(n)  # Kolmogorov-Smirnov at one in a thousand


class Shear:
    """A steady wind (1, 0.02 (x - 10)) m/s: a filament released at (10, 0) is at (10 + t, 0.01 t^2) at age t."""

    def __init__(self, dt: float) -> None:
        self.dt = dt

    def at_points(self, points: Array) -> Array:
        return np.array([np.ones(points.shape[1]), 0.02 * (points[0] - 10.0)])


def test_the_error_of_the_path_halves_with_the_step() -> None:
    errors = []
    for dt in (0.4, 0.2, 0.1):
        plume = Plume(PlumeTable(dispersion=0.0, release_rate=20.0), Source(), Arena(), 2)
        for _ in range(round(40.0 / dt)):
            plume.advance(Shear(dt))  # type: ignore[arg-type]
        ages = ages_of(plume, dt)
        np.testing.assert_allclose(plume.positions[0], 10.0 + ages, atol=1e-9)
        old = ages > 20.0
        errors.append(float(np.mean(np.abs(plume.positions[1] - 0.01 * ages**2)[old])))
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(2.0, rel=0.1)


def direct_sum(plume: Plume, table: PlumeTable, ages: Array, xs: list[float], ys: list[float]) -> list[float]:
    """(1.5) filament by filament."""
    totals = []
    for px, py in zip(xs, ys, strict=True):
        terms = []
        for (x, y), age in zip(plume.positions.T.tolist(), ages.tolist(), strict=True):
            radius = float(radius_at(table.growth, table.radius, table.growth_rate, np.array([age]))[0])
            r2 = (px - x) ** 2 + (py - y) ** 2
            terms.append(table.amount / (math.sqrt(8 * math.pi**3) * radius**3) * math.exp(-r2 / radius**2))
        totals.append(math.fsum(terms))
    return totals


coordinates = st.tuples(st.floats(-5.0, 105.0), st.floats(-55.0, 55.0))


@settings(deadline=None)
@given(
    filaments=st.lists(st.tuples(coordinates, st.floats(0.0, 150.0)), max_size=30),
    points=st.lists(coordinates, min_size=1, max_size=6),
    near=st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)),
    growth=st.sampled_from(["farrell1", "printed", "farrell2"]),
    radius=st.floats(0.03, 5.0),
)
def test_concentration_equals_the_direct_sum(
    filaments: list[tuple[tuple[float, float], float]],
    points: list[tuple[float, float]],
    near: tuple[float, float],
    growth: str,
    radius: float,
) -> None:
    table = PlumeTable(growth=growth, radius=radius)  # type: ignore[arg-type]
    plume = Plume(table, Source(), Arena(), 1)
    plume._now = 200.0
    plume._n = len(filaments)
    for n, ((x, y), age) in enumerate(filaments):
        plume._places[:, n] = x, y
        plume._births[n] = 200.0 - age
    if filaments:  # one point that surely smells something
        points = [*points, (filaments[0][0][0] + near[0] * radius, filaments[0][0][1] + near[1] * radius)]
    xs, ys = [x for x, _ in points], [y for _, y in points]
    ages = 200.0 - plume._births[: plume.alive]
    peak = table.amount / (math.sqrt(8 * math.pi**3) * radius**3)
    absent = 1e-17 * peak * max(1, len(filaments))  # what filaments beyond sqrt(40) radii may hold
    np.testing.assert_allclose(
        plume.concentration(xs, ys), direct_sum(plume, table, ages, xs, ys), rtol=1e-9, atol=absent
    )


def test_concentration_in_a_real_plume_equals_the_direct_sum() -> None:
    table = PlumeTable()
    wind = WindField(Wind(gain=0.5), Arena(), 6)
    plume = Plume(table, Source(), Arena(), 6)
    blow(plume, wind, 60.0)
    xs, ys = plume.positions[:, ::60].tolist()
    xs += [10.0, 40.0, -20.0, 400.0]
    ys += [0.0, 2.0, 7.0, -300.0]
    found = plume.concentration(xs, ys)
    np.testing.assert_allclose(found, direct_sum(plume, table, ages_of(plume, wind.dt), xs, ys), rtol=1e-9, atol=1e-10)
    assert found[:5].min() > 100.0
    assert found[-1] == 0.0


def test_the_mean_concentration_at_the_source_is_of_the_size_that_the_thesis_shows() -> None:
    """Table 1.1's Q with R(0) = 0.5 m, 10 filaments/s at 1 m/s: near 12.9 thousand ppt at the source."""
    wind = WindField(Wind(gain=0.0), Arena(), 1)
    plume = Plume(PlumeTable(), Source(), Arena(), 1)
    seen = []
    for _ in range(4000):
        plume.advance(wind)
        seen.append(plume.concentration([10.0], [0.0])[0])
    # A line of puffs on one side: rate Q / (sqrt(8 pi^3) R^3) (sqrt(pi) / 2) R / u
    theory = 10.0 * 5123.7618 / math.sqrt(8 * math.pi**3) / 0.5**3 * math.sqrt(math.pi) / 2 * 0.5
    # Every puff adds the same to the average, so the relative standard error is 1 / sqrt(3900) = 1.6 %.
    assert np.mean(seen[100:]) == pytest.approx(theory, rel=0.08)


def test_asking_for_concentrations_changes_nothing_and_the_seed_decides_everything() -> None:
    plumes = []
    for seed, ask in ((3, False), (3, True), (4, False)):
        wind = WindField(Wind(), Arena(), seed)
        plume = Plume(PlumeTable(), Source(), Arena(), seed)
        for _ in range(300):
            wind.advance()
            plume.advance(wind)
            if ask:
                plume.concentration([11.0, 20.0], [0.0, 1.0])
        plumes.append(plume.snapshot().tobytes())
    assert plumes[0] == plumes[1]
    assert plumes[0] != plumes[2]


def test_room_grows_with_the_plume() -> None:
    wind = WindField(Wind(gain=0.0), Arena(), 1)
    plume = Plume(PlumeTable(release_rate=400.0, dispersion=0.0), Source(), Arena(), 1)
    blow(plume, wind, 20.0)
    assert plume.alive == plume.released > 2 * 1024
    np.testing.assert_allclose(plume.positions[0], 10.0 + ages_of(plume, wind.dt), atol=1e-9)
    assert plume.snapshot().shape == (plume.alive, 3)
    np.testing.assert_allclose(plume.snapshot()[:, 2], plume.radii, rtol=1e-6)
