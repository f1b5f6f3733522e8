"""What all faults have in common: when they begin, and for those that pass, when they end.

Rules: a fault is data; what it does is in `world_server.faults` and, for what a robot does itself, `robot_agent.faults`.
It counts from the first tick at or after `at` until before the first tick at or after `until`. Nothing of this is in the
thesis: its links and robots never fail.
"""

from __future__ import annotations

from math import ceil
from typing import Annotated

from msgspec import Meta

from protocol.scenario.table import NonNegative, Table

FOREVER = 1e9  # s, the largest time: to the end of the run
RobotNumber = Annotated[int, Meta(ge=0, le=999)]
Edges = tuple[tuple[RobotNumber, RobotNumber], ...]  # (i, j): robot i hears robot j


class Fault(Table, frozen=True, kw_only=True, tag_field="kind"):
    """Something that goes wrong from `at` on."""

    at: NonNegative = 0.0  # s

    @property
    def end(self) -> float:
        """When it is over, s."""
        return FOREVER

    def ticks(self, dt: float) -> tuple[int, int]:
        """Its first tick and the first one after it."""
        return first_tick(self.at, dt), first_tick(self.end, dt)

    def about(self) -> str:
        """What goes wrong, in words that fit after "injected at 3 s: "."""
        raise NotImplementedError


class Passing(Fault, frozen=True, kw_only=True):
    """A fault that may end."""

    until: NonNegative = FOREVER  # s

    @property
    def end(self) -> float:
        return self.until

    @property
    def till(self) -> str:
        """` until 20 s`, or nothing when it never ends."""
        return "" if self.until >= FOREVER else f" until {self.until:g} s"


class OnEdges(Passing, frozen=True, kw_only=True):
    """A fault of the radio, on directed edges of the graph."""

    edges: Edges = ()  # empty: all

    @property
    def where(self) -> str:
        """The edges, in words."""
        if not self.edges:
            return "on every edge"
        shown = ", ".join(f"{i} hears {j}" for i, j in self.edges[:4])
        return f"where {shown}" + (f" and on {len(self.edges) - 4} more edges" if len(self.edges) > 4 else "")


def first_tick(t: float, dt: float) -> int:
    """The first tick at or after `t` seconds."""
    return ceil(t / dt - 1e-6)
