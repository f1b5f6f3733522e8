"""The wind field against a slow second implementation, its maximum principle, and its errors."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from protocol.errors import ScenarioError
from protocol.scenario.sections import Arena, Wind
from world_server.wind import WindField

Array = NDArray[np.float64]


def nodes_of(field: WindField) -> Array:
    """All nodes with the ghost ring, (2, m, m), as a view."""
    m = math.isqrt(field._flow.shape[1])
    nodes: Array = field._flow.reshape(2, m, m)
    return nodes


def fill(field: WindField, seed: int, scale: float) -> None:
    """Give every node a random wind."""
    field._flow[:] = scale * np.random.default_rng(seed).normal(size=field._flow.shape)


def slow_ring(nodes: Array, corners: Array, mean: tuple[float, float]) -> None:
    """Boundary as the thesis's sources do it: linear along the edges between the four corners."""
    m = nodes.shape[1]
    for c in range(2):
        ll, hl, lh, hh = (mean[c] + corners[4 * c + q] for q in range(4))
        for i in range(m):
            f = i / (m - 1)
            nodes[c, i, 0], nodes[c, i, m - 1] = ll + f * (hl - ll), lh + f * (hh - lh)
            nodes[c, 0, i], nodes[c, m - 1, i] = ll + f * (lh - ll), hl + f * (hh - hl)


def slow_step(nodes: Array, dt: float, dx: float, dy: float, diffusivity: float) -> Array:
    """One step of (1.2), (1.3) point by point, with the local diffusivity and as many substeps as positivity asks."""
    m = nodes.shape[1]
    peak = max(abs(value) for value in nodes.ravel().tolist())
    rate = sum(2 * max(diffusivity / 2, peak * d / 2) / d**2 for d in (dx, dy))
    substeps = max(1, math.ceil(dt * rate - 1e-9))
    h = dt / substeps
    for _ in range(substeps):
        after = nodes.copy()
        for i in range(1, m - 1):
            for j in range(1, m - 1):
                u, v = nodes[:, i, j]
                dif_x = max(diffusivity / 2, abs(u) * dx / 2)
                dif_y = max(diffusivity / 2, abs(v) * dy / 2)
                for c in range(2):
                    q = nodes[c]
                    advection = u * (q[i + 1, j] - q[i - 1, j]) / (2 * dx) + v * (q[i, j + 1] - q[i, j - 1]) / (2 * dy)
                    diffusion = (
                        dif_x * (q[i + 1, j] - 2 * q[i, j] + q[i - 1, j]) / dx**2
                        + dif_y * (q[i, j + 1] - 2 * q[i, j] + q[i, j - 1]) / dy**2
                    )
                    after[c, i, j] = q[i, j] + h * (diffusion - advection)
        nodes = after
    return nodes


@pytest.mark.parametrize(
    ("scale", "diffusivity", "dt"),
    [(0.3, 10.0, 0.1), (3.0, 10.0, 0.1), (2.0, 0.0, 0.5), (1.0, 10.0, 1.0), (4.0, 60.0, 1.0)],
)
def test_a_step_equals_the_slow_second_implementation(scale: float, diffusivity: float, dt: float) -> None:
    arena = Arena(x_min=-5.0, x_max=25.0, y_min=3.0, y_max=21.0)
    field = WindField(Wind(nodes=7, diffusivity=diffusivity, dt=dt, direction=0.7, gain=1.0), arena, 4)
    fill(field, 1, scale)
    before = nodes_of(field).copy()
    field.advance()
    slow_ring(before, field._corners.values(), (math.cos(0.7), math.sin(0.7)))
    np.testing.assert_allclose(nodes_of(field), slow_step(before, dt, 5.0, 3.0, diffusivity), rtol=0, atol=1e-12)


def test_where_the_wind_is_moderate_the_scheme_is_the_plain_centred_one() -> None:
    field = WindField(Wind(), Arena(), 2)
    fill(field, 3, 0.3)
    before = nodes_of(field).copy()
    field.advance()
    slow_ring(before, field._corners.values(), (1.0, 0.0))
    f, dt, dx, k = before, 0.1, 5.0, 10.0
    u, v = f[:, 1:-1, 1:-1]
    east, west, north, south = f[:, 2:, 1:-1], f[:, :-2, 1:-1], f[:, 1:-1, 2:], f[:, 1:-1, :-2]
    laplacian = (east + west + north + south - 4 * f[:, 1:-1, 1:-1]) / dx**2
    plain = f[:, 1:-1, 1:-1] + dt * (0.5 * k * laplacian - (u * (east - west) + v * (north - south)) / (2 * dx))
    np.testing.assert_allclose(nodes_of(field)[:, 1:-1, 1:-1], plain, rtol=0, atol=1e-13)


def test_bilinear_interpolation_equals_the_slow_one_and_is_held_beyond_the_ghost_ring() -> None:
    arena = Arena(x_min=-5.0, x_max=25.0, y_min=3.0, y_max=21.0)
    field = WindField(Wind(nodes=7), arena, 4)
    fill(field, 5, 1.0)
    rng = np.random.default_rng(6)
    inside = rng.uniform((-10.0, 0.0), (30.0, 24.0), (300, 2))  # out to the ghost ring
    corners = np.array([[-10.0, 0.0], [30.0, 24.0], [30.0, 0.0], [-5.0, 3.0], [25.0, 21.0]])
    outside = np.array([[-99.0, 10.0], [99.0, 10.0], [7.0, -99.0], [1e6, 1e6]])
    points = np.vstack([inside, corners, outside])
    u, v = field.at(points[:, 0], points[:, 1])
    q = nodes_of(field)
    for (x, y), found in zip(points.tolist(), np.column_stack([u, v]), strict=True):
        a, b = min(max((x + 10.0) / 5.0, 0.0), 8.0), min(max(y / 3.0, 0.0), 8.0)
        i, j = min(int(a), 7), min(int(b), 7)
        a, b = a - i, b - j
        slow = (1 - a) * ((1 - b) * q[:, i, j] + b * q[:, i, j + 1]) + a * (
            (1 - b) * q[:, i + 1, j] + b * q[:, i + 1, j + 1]
        )
        np.testing.assert_allclose(found, slow, rtol=0, atol=1e-12)


def test_interpolation_follows_the_field_from_step_to_step() -> None:
    field = WindField(Wind(gain=1.0), Arena(), 4)
    field.at([97.5], [47.5])
    for _ in range(50):
        field.advance()
    u, v = field.at([97.5], [47.5])  # the middle of the last cell
    np.testing.assert_allclose([u[0], v[0]], field.nodes_in_arena()[19:, 19:].mean(axis=(0, 1)), rtol=1e-6)


@settings(deadline=None, max_examples=60)
@given(
    seed=st.integers(0, 10**6),
    scale=st.floats(0.0, 50.0),
    diffusivity=st.floats(0.0, 100.0),
    dt=st.floats(0.01, 1.0),
    nodes=st.integers(3, 12),
    height=st.floats(10.0, 300.0),
)
def test_no_component_leaves_the_range_it_had(
    seed: int, scale: float, diffusivity: float, dt: float, nodes: int, height: float
) -> None:
    arena = Arena(y_min=0.0, y_max=height)
    field = WindField(Wind(nodes=nodes, diffusivity=diffusivity, dt=dt, gain=0.0), arena, 1)
    fill(field, seed, scale)
    before = nodes_of(field).copy()
    slow_ring(before, np.zeros(8), (1.0, 0.0))
    field.advance()
    rounding = 1e-12 * (1.0 + scale)
    for c in range(2):
        assert nodes_of(field)[c].max() <= before[c].max() + rounding
        assert nodes_of(field)[c].min() >= before[c].min() - rounding


def test_a_strong_gusty_wind_stays_finite_and_within_what_the_boundary_held() -> None:
    for seed in range(60):
        field = WindField(Wind(speed=2.0, gain=2.0, dt=0.2), Arena(), seed)
        ring, inside = 2.0, 0.0  # the mean that the field starts with, and the largest inside
        for k in range(1500):
            field.advance()
            if k % 5 == 0:
                largest = np.abs(nodes_of(field)).max()
                assert np.isfinite(largest)
                inside = max(inside, np.abs(nodes_of(field)[:, 1:-1, 1:-1]).max())
            ring = max(ring, np.abs(field._flow[:, field._ring]).max())
        assert inside <= ring * (1 + 1e-12)


def test_without_noise_the_mean_wind_stays_everywhere() -> None:
    field = WindField(Wind(speed=1.5, direction=2.0, gain=0.0), Arena(), 1)
    for _ in range(200):
        field.advance()
    u, v = field.at(np.linspace(0, 100, 40), np.linspace(-50, 50, 40))
    np.testing.assert_allclose(u, 1.5 * math.cos(2.0), rtol=1e-12)
    np.testing.assert_allclose(v, 1.5 * math.sin(2.0), rtol=1e-12)


def test_the_swing_at_mid_field_does_not_depend_on_the_step() -> None:
    """Variance of v at the middle for two steps: equal within five standard errors, from independent seeds."""
    means, errors = [], []
    for dt in (0.5, 0.25):
        squares = []
        for seed in range(16):
            field = WindField(Wind(gain=0.5, dt=dt, nodes=11), Arena(), seed)
            v = []
            for _ in range(round(150 / dt)):
                field.advance()
            for _ in range(round(400 / dt)):
                field.advance()
                v.append(nodes_of(field)[1, 6, 6])
            squares.append(float(np.mean(np.square(v))))
        means.append(np.mean(squares))
        errors.append(np.var(squares, ddof=1) / len(squares))
    assert abs(means[0] - means[1]) < 5.0 * math.sqrt(sum(errors))
    assert means[0] > 0.0


def test_the_same_seed_gives_the_same_wind_to_the_bit_and_another_seed_another() -> None:
    fields = [WindField(Wind(), Arena(), seed) for seed in (3, 3, 4)]
    for field in fields:
        for _ in range(20):
            field.advance()
        field.at([1.0], [2.0])
    a, b, c = (field._flow.tobytes() for field in fields)
    assert a == b
    assert a != c


def test_telemetry_holds_the_nodes_of_the_arena_by_x_and_y() -> None:
    field = WindField(Wind(nodes=5), Arena(), 1)
    fill(field, 8, 1.0)
    nodes = field.nodes_in_arena()
    assert nodes.shape == (5, 5, 2)
    assert nodes.dtype == np.float32
    u, v = field.at([25.0], [50.0])  # the second node in x, the last in y
    np.testing.assert_allclose(nodes[1, 4], [u[0], v[0]], rtol=1e-6)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_field_that_is_not_finite_says_what_to_change(bad: float) -> None:
    field = WindField(Wind(), Arena(), 1)
    nodes_of(field)[1, 4, 5] = bad
    with pytest.raises(ScenarioError, match=r"1 values, the first at .*\(1, 4, 5\); lower wind.gain \(now 0.15\)"):
        field.advance()


def test_a_grid_that_would_take_for_ever_is_refused() -> None:
    field = WindField(Wind(nodes=201), Arena(x_min=0.0, x_max=1.0), 1)
    with pytest.raises(ScenarioError, match=r"substeps .* lower wind.nodes \(now 201\)"):
        field.advance()
