"""The closed forms of filament growth against integrated differential equations."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from world_server.growth import radius_at

RATES: dict[str, Callable[[float, float, float], float]] = {  # dR/dt by R, R(0), gamma
    "farrell1": lambda r, r0, gamma: 1.5 * gamma * r ** (1 / 3),
    "printed": lambda r, r0, gamma: 1.5 * gamma * r0 ** (1 / 3),
    "farrell2": lambda r, r0, gamma: gamma / (2 * r),
}
laws = pytest.mark.parametrize("law", sorted(RATES))


@laws
@given(r0=st.floats(0.03, 3.0), gamma=st.floats(0.0, 0.05), age=st.floats(0.1, 300.0))
def test_radius_solves_the_growth_equation(law: str, r0: float, gamma: float, age: float) -> None:
    ages = np.linspace(0.0, age, 5)
    path = solve_ivp(lambda t, r: [RATES[law](r[0], r0, gamma)], (0.0, age), [r0], t_eval=ages, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(radius_at(law, r0, gamma, ages), path.y[0], rtol=1e-6)


@laws
def test_a_filament_starts_with_its_first_radius_and_never_shrinks(law: str) -> None:
    radii = radius_at(law, 0.5, 0.001, np.linspace(0.0, 200.0, 50))
    assert radii[0] == pytest.approx(0.5, rel=1e-15)
    assert np.all(np.diff(radii) > 0.0)


def test_with_the_first_radius_of_half_a_metre_the_three_laws_are_close_at_90_seconds() -> None:
    at_90 = [float(radius_at(law, 0.5, 0.001, np.array([90.0]))[0]) for law in ("printed", "farrell1", "farrell2")]
    assert at_90 == pytest.approx([0.607, 0.611, 0.583], abs=5e-4)


def test_an_unknown_law_is_refused_by_name() -> None:
    with pytest.raises(ValueError, match="'pompy' is none of farrell1"):
        radius_at("pompy", 0.5, 0.001, np.zeros(1))
