"""What the recorder is told of the truth, as often as the scenario's `recording` table says.

Rules: nothing here changes a run, and nothing is ever sent to a robot. Telemetry of a tick is taken before the world
prepares the next one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import ArrayLike

from protocol.messages import Field, Message, Truth
from world_server.world import World


class Telemetry:
    """Decides at every tick what is due."""

    def __init__(self, world: World, truth: Callable[[Message], None], field: Callable[[Message], None]) -> None:
        recording, dt = world.scenario.recording, world.dt
        self._truth_ticks = max(1, round(recording.truth_period / dt))
        self.field_ticks = max(1, round(recording.field_period / dt))
        self._world = world
        self._truth = truth
        self._field = field
        self._count = -(-world.tick // self._truth_ticks)  # a world that came back has told of the ticks before

    def tick(self, *, last: bool = False) -> None:
        """Publish what is due at the world's tick; at the last one the robots in any case."""
        k = self._world.tick
        if last or k % self._truth_ticks == 0:
            self._truth(truth_of(self._world, self._count))
            self._count += 1
        if k % self.field_ticks == 0:
            self._field(field_of(self._world))


def truth_of(world: World, count: int) -> Truth:
    """The robots as they are; `count` numbers these messages without a gap."""
    b = world.bodies
    table = np.empty((len(b.x), 9))
    for column, values in enumerate(_columns(world)):
        table[:, column] = values
    return Truth(world.tick, world.t, count, table.astype("<f8").tobytes())


def field_of(world: World) -> Field:
    """Plume and wind as they are."""
    world.field.advance_to(world.t)
    filaments = world.field.plume.snapshot().astype("<f4")
    wind = world.field.wind.nodes_in_arena().astype("<f4")
    return Field(world.tick, world.t, filaments.tobytes(), wind.tobytes())


def _columns(world: World) -> Iterator[ArrayLike]:
    b = world.bodies
    yield from (b.x, b.y, b.theta, b.nu, b.omega)
    yield from world.torques
    yield world.concentration
    yield [i in world.live for i in range(len(b.x))]
