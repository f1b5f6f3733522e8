"""sig(x)^a and its implicit step."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.sig import explicit_step, implicit_step, sig

phis = st.floats(-1e4, 1e4)
gains = st.floats(0.0, 20.0)
exponents = st.floats(0.1, 0.95)


@given(phi=phis, g=gains, b=gains, a=exponents, dt_k=st.floats(1e-6, 50.0))
def test_implicit_step_solves_its_equation(phi, g, b, a, dt_k):
    rate = implicit_step(phi, g, b, a, dt_k)
    end = phi - dt_k * rate
    assert end * phi >= -1e-12 * phi * phi
    assert abs(end) <= abs(phi) * (1 + 1e-12)
    if abs(end) > 1e-3 * abs(phi):  # otherwise the subtraction has lost it
        assert rate == pytest.approx(explicit_step(end, g, b, a, 0.0), rel=1e-6)


@given(phi=phis, g=gains, b=gains, a=exponents)
def test_implicit_step_becomes_the_printed_law_as_the_step_shrinks(phi, g, b, a):
    printed = explicit_step(phi, g, b, a, 0.0)
    assert implicit_step(phi, g, b, a, 0.0) == printed
    if abs(phi) > 1e-3:
        assert implicit_step(phi, g, b, a, 1e-9) == pytest.approx(printed, rel=1e-4)


@given(phi=phis, a=exponents)
def test_sig_is_odd(phi, a):
    assert sig(-phi, a) == -sig(phi, a)
