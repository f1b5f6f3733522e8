"""Who stops and who comes back at which tick, and what is to be said of the faults, read off the scenario.

Rules: pure data; the barrier (`world_server.session`) does what it says.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from protocol.scenario import Scenario
from protocol.scenario.faults import FOREVER, Crash, Hang, first_tick

CRASH, HANG = "crash", "hang"


@dataclass(slots=True)
class Due:
    """What happens at one tick, before anybody is told what it senses there."""

    back: list[int] = field(default_factory=list)  # robots that take part again
    stops: list[tuple[int, str]] = field(default_factory=list)  # robots that stop, and how
    begun: list[tuple[int, str]] = field(default_factory=list)  # (robot or -1, what goes wrong from now on, in words)


class Plan:
    """The faults of a run by tick."""

    def __init__(self, scenario: Scenario) -> None:
        self._due: dict[int, Due] = {}
        self._last_back = -1
        dt = scenario.timing.tick
        for fault in scenario.faults:
            first, end = fault.ticks(dt)
            due = self._at(first)
            due.begun.append((getattr(fault, "robot", -1), fault.about()))
            if isinstance(fault, Crash):
                due.stops.append((fault.robot, CRASH))
                if fault.restart:
                    self.add_return(max(first + 1, first_tick(fault.at + fault.restart, dt)), fault.robot)
            elif isinstance(fault, Hang) and first < end:
                due.stops.append((fault.robot, HANG))
                if fault.until < FOREVER:
                    self.add_return(end, fault.robot)

    def at(self, tick: int) -> Due | None:
        """What is due at `tick`; None: nothing."""
        return self._due.get(tick)

    def add_return(self, tick: int, robot: int) -> None:
        """Let `robot` take part again at `tick`."""
        self._at(tick).back.append(robot)
        self._last_back = max(self._last_back, tick)

    def returns_after(self, tick: int) -> bool:
        """Whether anybody is to come back after `tick`."""
        return self._last_back > tick

    def returns(self, robot: int, tick: int) -> bool:
        """Whether `robot` is to come back after `tick`."""
        return any(at > tick and robot in due.back for at, due in self._due.items())

    def _at(self, tick: int) -> Due:
        return self._due.setdefault(tick, Due())
