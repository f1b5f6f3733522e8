"""States that are overtaken by the next one."""

from __future__ import annotations

from protocol.randomness import rng_for
from protocol.scenario.faults import Reorder
from world_server.faults.arrival import BEHIND, Arrival


class ReorderEffect:
    """Draws by ("link", "reorder", number of the fault, i, j, tick)."""

    longest = 1

    def __init__(self, fault: Reorder, number: int, seed: int, dt: float) -> None:
        self._p, self._number, self._seed = fault.probability, number, seed

    def __call__(self, i: int, j: int, sent: int, arrivals: list[Arrival]) -> list[Arrival]:
        overtaken = rng_for(self._seed, "link", "reorder", self._number, i, j, sent).uniform() < self._p
        return [Arrival(a.tick + 1, BEHIND) for a in arrivals] if overtaken else arrivals
