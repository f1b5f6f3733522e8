"""Wind and plume together, stepped in lock step, and their life before the run starts.

Rules: the field at time t is that of step floor(t / dt + 1e-9), constant until the next. Steps are counted from the
start of the warm-up, so that no step number, and with it no address of noise, is used twice.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from protocol.scenario import Scenario
from world_server.plume import Plume
from world_server.snapshot import AirState, pack, unpack
from world_server.wind import WindField

Array = NDArray[np.float64]


class Field:
    """What the air holds, as a function of time."""

    def __init__(self, scenario: Scenario) -> None:
        self.wind = WindField(scenario.wind, scenario.arena, scenario.seed)
        self.plume = Plume(scenario.plume, scenario.source, scenario.arena, scenario.seed)
        dt = scenario.wind.dt
        self._samples = math.floor(scenario.sensors.wind_history + 1e-9)  # of the wind, at 1 Hz
        # The wind blows for as long as either needs it; the source releases during the last `warm_up` seconds.
        # Without a source nothing has to be carried to where it is met.
        warm_up = scenario.plume.warm_up if scenario.plume.release_rate > 0.0 else 0.0
        self._release_at = -_steps(warm_up, dt)
        self._step = min(self._release_at, -_steps(self._samples, dt))  # 0 at t = 0

    def warm_up(self, points: Array) -> Array:
        """Live through the time before t = 0 and return the wind recorded meanwhile.

        The first filaments start into a wind that still is the mean inside the arena; after two or three times
        extent / speed, well within the default warm-up, that is forgotten.

        Args:
            points: where to record, shape (N, 2), m.
        Returns:
            Wind at t = -S, ..., -2, -1 s, oldest first, shape (S, N, 2), m/s; S is `sensors.wind_history` in whole
            seconds.
        """
        record = np.empty((self._samples, *points.shape))
        for s in range(self._samples):
            self.advance_to(float(s - self._samples))
            record[s] = self.wind.at_points(points.T).T
        self.advance_to(0.0)
        return record

    @property
    def state(self) -> AirState:
        """All that the coming steps need."""
        wind_step, flow, corners = self.wind.state
        plume_step, released, left, room, places, births = self.plume.state
        return AirState(
            self._step, wind_step, pack(flow), pack(corners), plume_step, released, left, room, pack(places), pack(births)
        )

    def restore(self, s: AirState) -> None:
        """Go on from `s`, instead of living through the warm-up."""
        self._step = s.step
        self.wind.state = (s.wind_step, unpack(s.flow, 2, -1), unpack(s.corners, 2, -1))
        births = unpack(s.births, -1)
        places = unpack(s.places, 2, births.size)
        self.plume.restore((s.plume_step, s.released, s.left, s.room, places, births), self.wind.dt)

    def advance_to(self, t: float) -> None:
        """Step wind and plume up to time `t`, s; a time that is past already changes nothing."""
        target = math.floor(t / self.wind.dt + 1e-9)
        while self._step < target:
            self.wind.advance()
            if self._step >= self._release_at:
                self.plume.advance(self.wind)
            self._step += 1


def _steps(seconds: float, dt: float) -> int:
    return math.ceil(seconds / dt - 1e-9)
