"""States that arrive late."""

from __future__ import annotations

from protocol.randomness import rng_for
from protocol.scenario.faults import Delay
from world_server.faults.arrival import Arrival


class DelayEffect:
    """Whole ticks; draws by ("link", "delay", number of the fault, i, j, tick)."""

    def __init__(self, fault: Delay, number: int, seed: int, dt: float) -> None:
        self._fault, self._number, self._seed, self._dt = fault, number, seed, dt
        self.longest = round((fault.delay + fault.jitter) / dt)

    def __call__(self, i: int, j: int, sent: int, arrivals: list[Arrival]) -> list[Arrival]:
        fault, late = self._fault, self._fault.delay
        if fault.jitter or fault.probability < 1.0:
            draws = rng_for(self._seed, "link", "delay", self._number, i, j, sent)
            if draws.uniform() >= fault.probability:
                return arrivals
            late += fault.jitter * draws.uniform()
        ticks = round(late / self._dt)
        return [Arrival(tick + ticks, turn) for tick, turn in arrivals]
