"""Wind and plume in lock step, and the time before the start."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from protocol.scenario import Scenario
from protocol.scenario.sections import Plume, Sensors, Wind
from world_server.field import Field
from world_server.wind import WindField

POINTS = np.array([[95.0, -48.0], [50.0, 0.0], [12.0, 30.0]])


def short(**tables: object) -> Scenario:
    """A scenario with little to warm up."""
    base = Scenario(seed=7, plume=Plume(warm_up=20.0), sensors=Sensors(wind_history=8.0), wind=Wind(gain=1.0))
    return msgspec.structs.replace(base, **tables)


def test_recorded_wind_is_the_field_at_whole_seconds_oldest_first() -> None:
    scenario = short()
    record = Field(scenario).warm_up(POINTS)
    assert record.shape == (8, 3, 2)
    wind = WindField(scenario.wind, scenario.arena, scenario.seed)
    for s in range(8):
        while wind.step < round((20 - 8 + s) / 0.1):
            wind.advance()
        assert record[s].tolist() == np.column_stack(wind.at(POINTS[:, 0], POINTS[:, 1])).tolist()


def test_wind_is_recorded_from_before_the_release_when_the_history_is_longer() -> None:
    field = Field(short(plume=Plume(warm_up=3.0)))
    record = field.warm_up(POINTS)
    assert record.shape == (8, 3, 2)
    assert np.unique(record[:, 0, 1]).size == 8  # near the edge, where the noise is felt at once
    assert field.wind.step == 80
    assert field.plume.step == 30


def test_without_warm_up_the_plume_starts_at_zero() -> None:
    field = Field(short(plume=Plume(warm_up=0.0), sensors=Sensors(wind_history=0.0)))
    assert field.warm_up(POINTS).shape == (0, 3, 2)
    assert (field.wind.step, field.plume.alive) == (0, 0)
    field.advance_to(2.0)
    assert field.wind.step == field.plume.step == 20


def test_the_field_at_a_time_is_that_of_the_step_begun_there_whatever_the_ticks() -> None:
    whole, ticked = Field(short()), Field(short())
    whole.warm_up(POINTS)
    ticked.warm_up(POINTS[:1])
    whole.advance_to(5.0)
    for k in range(1, 101):
        ticked.advance_to(k * 0.05)
    assert whole.wind.step == ticked.wind.step == 250
    assert whole.plume.snapshot().tobytes() == ticked.plume.snapshot().tobytes()
    assert whole.wind.nodes_in_arena().tobytes() == ticked.wind.nodes_in_arena().tobytes()


def test_a_time_that_is_past_changes_nothing() -> None:
    field = Field(short())
    field.warm_up(POINTS)
    field.advance_to(0.0)
    field.advance_to(0.099)
    field.advance_to(-3.0)
    assert field.wind.step == 200
    field.advance_to(0.1)
    assert field.wind.step == 201


def test_the_default_warm_up_fills_the_arena_from_the_source_to_the_downwind_edge() -> None:
    field = Field(Scenario(seed=2))
    field.warm_up(POINTS)
    x, _ = field.plume.positions
    assert x.min() < 11.0
    assert x.max() > 104.0
    assert field.plume.alive == pytest.approx(950, abs=5 * 31 + 50)  # 95 m at 1 m/s, 10/s, and gusts
    assert field.plume.released == field.plume.alive + field.plume.left
