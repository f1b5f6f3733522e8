"""plume-map: what a record says of the way of the air, and of where the robot was."""

from math import hypot, inf, nan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from judging_helpers import reading, view
from plume_helpers import ARENA, TABLE

from robot_agent.decision.plume_map import PlumeMapDecision
from robot_agent.hand import Own
from robot_agent.plume.backtrace import CORRELATED, RECENT, WindPast
from robot_agent.plume.events import LAGS, SIZE, pack, unpack

bends = st.floats(-2.0, 2.0)


@given(
    st.floats(-10.0, 110.0), st.floats(-60.0, 60.0), st.floats(0.01, 10.0), st.booleans(), st.floats(-8.0, 8.0),
    st.floats(-8.0, 8.0), st.lists(st.tuples(bends, bends), min_size=len(LAGS) - 1, max_size=len(LAGS) - 1),
)  # fmt: skip
def test_a_record_says_where_the_air_was_within_a_part_of_what_is_known_of_it(x, y, D, hit, u, v, turns):
    """The wind of the first stretch is any; the others end within two deviations of where the mean wind leads."""
    wx, wy, before = LAGS[0] * u, LAGS[0] * v, LAGS[0]
    way = [(wx, wy)]
    for (p, q), lag in zip(turns, LAGS[1:], strict=True):
        sigma = (0.49 + D * lag) ** 0.5
        wx, wy, before = wx * lag / before + p * sigma, wy * lag / before + q * sigma, lag
        way.append((wx, wy))
    bits = pack(7, hit, x, y, D, way, ARENA)
    event = unpack(bits, ARENA)
    assert len(bits) == SIZE
    assert (event.robot, event.hit) == (7, hit)
    assert hypot(event.x - x, event.y - y) < 0.024
    assert event.D == pytest.approx(D, rel=0.031)
    (_, _, _), (lag, bx, by), *rest = event.way
    assert hypot(event.x - bx - way[0][0], event.y - by - way[0][1]) < 0.01 + 0.06 * hypot(*way[0])
    # Half a step of the latest stretch, and no more: rounding does not add up. Steps widen with the bend.
    error = hypot(event.x - bx - way[0][0], event.y - by - way[0][1])
    for (lag, bx, by), (dx, dy) in zip(rest, way[1:], strict=True):
        sigma = (0.49 + event.D * lag) ** 0.5
        error = hypot(event.x - bx - dx, event.y - by - dy)
        assert error < 0.48 * 1.42 * sigma


def test_a_way_that_hardly_bends_is_told_to_a_tenth_of_its_deviation():
    for n in range(100):
        u, v = 1.0 + 0.003 * n, 0.2 - 0.004 * n
        way = [(lag * u, lag * v + 0.001 * lag * (n % 7)) for lag in LAGS]
        event = unpack(pack(0, False, 50.0, 0.0, 0.05, way, ARENA), ARENA)
        for (lag, bx, by), (dx, dy) in zip(event.way[1:], way, strict=True):
            assert hypot(event.x - bx - dx, event.y - by - dy) < 0.15 * (0.49 + 0.05 * lag) ** 0.5


def test_when_the_wind_has_just_turned_the_way_is_still_told():
    """Its deviation has grown with the turn: so have the steps."""
    past = WindPast(TABLE, 1.0)
    past.prefill([(-1.0, 0.3)] * 105 + [(1.0, 0.3)] * 5)
    way, D = past.way(), past.diffusivity()
    event = unpack(pack(0, False, 50.0, 0.0, D, way, ARENA), ARENA)
    for (lag, bx, by), (dx, dy) in zip(event.way[1:], way, strict=True):
        assert hypot(event.x - bx - dx, event.y - by - dy) < 0.7 * (0.49 + event.D * lag) ** 0.5


def test_without_wind_history_the_way_goes_on_at_the_mean_wind():
    past = WindPast(TABLE, 1.0)
    past.record((1.0, 0.5))
    past.record((2.0, 0.5))
    assert past.way()[0] == (3.0, 1.0)
    assert past.way()[-1] == pytest.approx((110 * 1.5, 110 * 0.5))


@pytest.mark.parametrize("broken", [1e300, inf, -inf, nan])
def test_the_latest_samples_say_the_way_and_the_variance_whatever_was_before(broken):
    """Sums go on from sample to sample: what a broken sensor once read must leave them."""
    winds = np.random.default_rng(7).normal((1.0, -0.2), (0.3, 0.4), (400, 2))
    past = WindPast(TABLE, 1.0)
    past.record((broken, broken))
    past.prefill(map(tuple, winds.tolist()))
    latest = winds[::-1].cumsum(0)
    assert past.way() == [pytest.approx(latest[round(lag) - 1]) for lag in LAGS]
    variance = winds[-RECENT:].var(0).sum()
    assert past.diffusivity() == pytest.approx(TABLE.spread + TABLE.meander * CORRELATED * variance)


def test_an_own_position_after_a_hang_is_the_reading_and_not_what_the_wheels_would_have_made_of_it():
    scenario = view(algorithm="plume-map", topology="line")
    decision = PlumeMapDecision(scenario)
    decision.record(Own(reading(0, x=50.0), scenario.body))
    back = Own(reading(200, x=52.0), scenario.body, 0)
    decision.record(back)
    assert decision._place == (200, back.x, back.y)
