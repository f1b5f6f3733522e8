"""States that are lost."""

from __future__ import annotations

from protocol.randomness import rng_for
from protocol.scenario.faults import Loss
from world_server.faults.arrival import Arrival


class LossEffect:
    """Draws by ("link", "loss", number of the fault, i, j, tick)."""

    longest = 0

    def __init__(self, fault: Loss, number: int, seed: int, dt: float) -> None:
        self._p, self._number, self._seed = fault.probability, number, seed

    def __call__(self, i: int, j: int, sent: int, arrivals: list[Arrival]) -> list[Arrival]:
        lost = rng_for(self._seed, "link", "loss", self._number, i, j, sent).uniform() < self._p
        return [] if lost else arrivals
