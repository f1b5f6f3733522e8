"""The radio that the world emulates: whose state of which tick each robot hears.

Rules: what is heard is decided here and told to the robots in `Reading.hears`, so that it repeats exactly; only
edges that `Links` has open at the tick are heard; who is not alive is not heard. Faults of the radio are in
`world_server.faults.channel`.
"""

from __future__ import annotations

from collections.abc import Container

from protocol.scenario import Scenario
from world_server.faults.channel import channel_of
from world_server.links import Links


class Radio:
    """The declared graph as it is heard."""

    def __init__(self, scenario: Scenario, links: Links) -> None:
        self._links = links
        self.channel = channel_of(scenario)
        self.since: dict[int, int] = {}  # robots that have stopped and come back: since when they take part

    def admit(self, robot: int, tick: int) -> None:
        """`robot` takes part again from `tick` on: what was under way before is lost."""
        self.since[robot] = tick

    def hears(self, i: int, tick: int, live: Container[int]) -> tuple[tuple[int, int], ...]:
        """The (neighbour, tick) states that robot `i` waits for at `tick`."""
        if self.channel is None:
            return tuple((j, tick) for j in self._links.rows[i] if j in live)
        row = tuple(j for j in self._links.rows[i] if j in live)
        return self.channel.heard(i, tick, row, self.since)
