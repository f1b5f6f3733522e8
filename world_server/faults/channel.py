"""What becomes of a state between its sender and a neighbour: when it arrives, if at all.

Rules: the fate of a state depends on edge, tick of sending and seed alone, so that it may be asked for at any time and is
the same again. Faults act in the order of the scenario, each if it counts at the tick of sending. A state that is under
way to or from a robot that stops (crash, hang) is lost with it: over real wires nobody could say whether it arrived.
A state is never asked for before it was sent nor by who was not linked to its sender then.
"""

from __future__ import annotations

from collections.abc import Mapping

from protocol.scenario import Scenario
from protocol.scenario.faults import HISTORY, Delay, Duplicate, Fault, Loss, OnEdges, Partition, Reorder
from world_server.faults.arrival import Arrival, Effect
from world_server.faults.delay import DelayEffect
from world_server.faults.duplicate import DuplicateEffect
from world_server.faults.loss import LossEffect
from world_server.faults.partition import PartitionEffect
from world_server.faults.reorder import ReorderEffect

EFFECTS: dict[type[Fault], type[Effect]] = {
    Loss: LossEffect,
    Delay: DelayEffect,
    Duplicate: DuplicateEffect,
    Reorder: ReorderEffect,
    Partition: PartitionEffect,
}

LONGEST = HISTORY - 2  # ticks; what would arrive later is lost, for the robot does not have it any more

Row = tuple[int, ...]  # robots, ascending


class _Acting:
    """A fault with its times and edges."""

    def __init__(self, fault: Fault, number: int, scenario: Scenario) -> None:
        dt = scenario.timing.tick
        self.first, self.end = fault.ticks(dt)
        self.edges = frozenset(fault.edges) if isinstance(fault, OnEdges) else frozenset()
        self.effect = EFFECTS[type(fault)](fault, number, scenario.seed, dt)  # type: ignore[call-arg]


def channel_of(scenario: Scenario) -> Channel | None:
    """The edges of a run, or None when their radio has no faults."""
    return Channel(scenario) if any(type(fault) in EFFECTS for fault in scenario.faults) else None


class Channel:
    """All edges of a run whose radio has faults."""

    def __init__(self, scenario: Scenario) -> None:
        self._acting = [
            _Acting(fault, n, scenario) for n, fault in enumerate(scenario.faults) if type(fault) in EFFECTS
        ]
        self._longest = min(LONGEST, sum(each.effect.longest for each in self._acting))  # faults add up
        self.rows: dict[int, dict[int, Row]] = {}  # tick -> robot -> whom it was linked to then
        self._fates: dict[tuple[int, int, int], list[Arrival]] = {}

    def heard(self, i: int, tick: int, row: Row, since: Mapping[int, int]) -> tuple[tuple[int, int], ...]:
        """The (neighbour, tick) states that robot i hears at `tick`, in the order of their arrival.

        Args:
            row: whom it is linked to at this tick and who takes part.
            since: since which tick a robot takes part without a break; left out: from the start.
        """
        rows = self.rows
        rows.setdefault(tick, {})[i] = row
        rows.pop(tick - self._longest - 1, None)
        found = []
        earliest = max(tick - self._longest, since.get(i, 0))
        for j in row:
            for sent in range(max(earliest, since.get(j, 0)), tick + 1):
                if j not in rows.get(sent, {}).get(i, ()):
                    continue
                found += [(a.turn, j, sent) for a in self._fate(i, j, sent) if a.tick == tick]
        found.sort()
        return tuple((j, sent) for _, j, sent in found)

    def _fate(self, i: int, j: int, sent: int) -> list[Arrival]:
        fates = self._fates
        key = (i, j, sent)
        arrivals = fates.get(key)
        if arrivals is None:
            arrivals = [Arrival(sent)]
            for each in self._acting:
                if each.first <= sent < each.end and (not each.edges or (i, j) in each.edges):
                    arrivals = [a for a in each.effect(i, j, sent, arrivals) if a.tick - sent <= LONGEST]
            if len(fates) > 100_000:
                fates.clear()
            if self._longest:
                fates[key] = arrivals
        return arrivals
