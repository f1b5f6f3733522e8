"""Groups that do not hear each other."""

from __future__ import annotations

from protocol.scenario.faults import Partition
from world_server.faults.arrival import Arrival


class PartitionEffect:
    """Nothing random."""

    longest = 0

    def __init__(self, fault: Partition, number: int, seed: int, dt: float) -> None:
        self._fault = fault

    def __call__(self, i: int, j: int, sent: int, arrivals: list[Arrival]) -> list[Arrival]:
        return [] if self._fault.parts(i, j) else arrivals
