"""A world that is slow: how long its process is to sleep at a tick. The truth is the same."""

from __future__ import annotations

from protocol.scenario import Scenario
from protocol.scenario.faults import WorldSlow


class Slowness:
    """All of a run."""

    def __init__(self, scenario: Scenario) -> None:
        dt = scenario.timing.tick
        self._faults = [(*fault.ticks(dt), fault.pause) for fault in scenario.faults if isinstance(fault, WorldSlow)]

    def pause(self, tick: int) -> float:
        """Wall-clock s to sleep at `tick`."""
        return sum(pause for first, end, pause in self._faults if first <= tick < end)
