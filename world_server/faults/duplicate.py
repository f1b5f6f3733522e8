"""States that arrive twice."""

from __future__ import annotations

from protocol.randomness import rng_for
from protocol.scenario.faults import Duplicate
from world_server.faults.arrival import BEHIND, Arrival


class DuplicateEffect:
    """Draws by ("link", "duplicate", number of the fault, i, j, tick)."""

    def __init__(self, fault: Duplicate, number: int, seed: int, dt: float) -> None:
        self._p, self._number, self._seed = fault.probability, number, seed
        self.longest = max(1, round(fault.after / dt))

    def __call__(self, i: int, j: int, sent: int, arrivals: list[Arrival]) -> list[Arrival]:
        twice = rng_for(self._seed, "link", "duplicate", self._number, i, j, sent).uniform() < self._p
        return arrivals + [Arrival(a.tick + self.longest, BEHIND) for a in arrivals] if twice else arrivals
