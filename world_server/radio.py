"""The radio that the world emulates: whose state of which tick each robot hears.

Rules: what is heard is decided here and told to the robots in `Reading.hears`, so that it repeats exactly; only
edges that `Links` has open at the tick are heard; who is not alive is not heard.
"""

from __future__ import annotations

from collections.abc import Container

from protocol.scenario import Scenario
from world_server.links import Links


class Radio:
    """The declared graph as it is heard."""

    def __init__(self, scenario: Scenario, links: Links) -> None:
        self._links = links

    def hears(self, i: int, tick: int, live: Container[int]) -> tuple[tuple[int, int], ...]:
        """The (neighbour, tick) states that robot `i` waits for at `tick`."""
        return tuple((j, tick) for j in self._links.rows[i] if j in live)
