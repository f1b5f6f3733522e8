"""Sensor noise: addressed, independent per sensor, absent when switched off."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from protocol.messages import Reading
from protocol.scenario.sections import Sensors
from world_server import sensors

EXACT = Reading(2, 40, 2.0, 10.0, -3.0, 0.5, 0.7, 0.1, 1.0, -0.2, 800.0, ((1, 40),), ((1.0, 0.0),))


def of_tick(k: int, robot: int = 2) -> Reading:
    """The exact reading at another tick or of another robot."""
    return msgspec.structs.replace(EXACT, tick=k, robot=robot)


def test_without_noise_the_reading_is_handed_on_and_nothing_is_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(*address: object) -> None:
        raise AssertionError(f"drew from {address}")

    monkeypatch.setattr(sensors, "rng_for", forbidden)
    assert sensors.observe(EXACT, Sensors(), 1) is EXACT
    monkeypatch.undo()
    assert sensors.observe(EXACT, Sensors(wind_noise=0.1), 1) != EXACT


@pytest.mark.parametrize(
    ("table", "fields"),
    [
        (Sensors(wind_noise=0.3), ("wind_x", "wind_y")),
        (Sensors(position_noise=0.3), ("x", "y")),
        (Sensors(heading_noise=0.3), ("theta",)),
        (Sensors(concentration_noise=0.3), ("concentration",)),
    ],
)
def test_each_sensor_has_noise_of_its_own_size_on_its_own_fields(table: Sensors, fields: tuple[str, ...]) -> None:
    n = 3000
    seen = [sensors.observe(of_tick(k), table, 5) for k in range(n)]
    for name in Reading.__struct_fields__:
        exact = getattr(EXACT, name)
        if name not in fields and name != "tick":
            assert {getattr(reading, name) for reading in seen} == {exact}
    for name in fields:
        exact = getattr(EXACT, name)
        errors = np.array([getattr(reading, name) - exact for reading in seen]) / 0.3
        if name == "concentration":
            errors /= exact
        assert abs(errors.mean()) < 5.0 / np.sqrt(n)
        assert abs(errors.var() - 1.0) < 0.2
    if len(fields) == 2:
        pairs = np.array([[getattr(r, name) - getattr(EXACT, name) for name in fields] for r in seen])
        assert abs(np.corrcoef(pairs.T)[0, 1]) < 5.0 / np.sqrt(n)


def test_one_sensors_noise_changes_no_others_draws() -> None:
    alone = sensors.observe(EXACT, Sensors(heading_noise=0.1), 5)
    all_noisy = Sensors(wind_noise=0.2, position_noise=0.3, heading_noise=0.1, concentration_noise=0.4)
    together = sensors.observe(EXACT, all_noisy, 5)
    assert alone.theta == together.theta
    assert together.x != EXACT.x


def test_no_two_sensors_share_a_draw() -> None:
    seen = sensors.observe(EXACT, Sensors(wind_noise=1.0, position_noise=1.0, heading_noise=1.0, concentration_noise=1.0), 5)
    errors = [getattr(seen, name) - getattr(EXACT, name) for name in ("x", "y", "theta", "wind_x", "wind_y")]
    errors.append(seen.concentration / EXACT.concentration - 1.0)
    assert len({round(error, 9) for error in errors}) == 6


def test_noise_differs_by_seed_robot_and_tick_and_repeats() -> None:
    table = Sensors(wind_noise=0.1)
    cases = [(of_tick(1), 5), (of_tick(2), 5), (of_tick(1, robot=3), 5), (of_tick(1), 6)]
    first = [sensors.observe(reading, table, seed).wind_x for reading, seed in cases]
    assert len(set(first)) == 4
    assert first == [sensors.observe(reading, table, seed).wind_x for reading, seed in cases]


def test_concentration_is_never_negative_and_clean_air_stays_clean() -> None:
    rough = Sensors(concentration_noise=2.0)
    seen = [sensors.observe(of_tick(k), rough, 5).concentration for k in range(300)]
    assert min(seen) == 0.0
    assert max(seen) > 1600.0
    clean = msgspec.structs.replace(EXACT, concentration=0.0)
    assert sensors.observe(clean, rough, 5).concentration == 0.0
