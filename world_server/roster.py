"""Who says that it is linked to whom: what a robot that comes back has to wait for.

Rules: pure. All robots joined with their declared links; from then on a robot says what has changed (`Linked`).
"""

from __future__ import annotations

from collections.abc import Container

from protocol.messages import Linked
from protocol.scenario import Scenario, linked_to


class Roster:
    """The links of a run, as their ends see them."""

    def __init__(self, scenario: Scenario) -> None:
        self._declared = [frozenset(linked_to(scenario.graph, i)) for i in range(scenario.robots)]
        self._seen = list(self._declared)

    def note(self, linked: Linked) -> None:
        """Take a robot's word."""
        self._seen[linked.robot] = frozenset(linked.links)

    def complete(self, robot: int, live: Container[int]) -> bool:
        """Whether `robot` and all its declared neighbours that take part see each other."""
        mine = self._seen[robot]
        return all(j in mine and robot in self._seen[j] for j in self._declared[robot] if j in live)

    def is_seen(self, robot: int, live: Container[int]) -> bool:
        """Whether anybody who takes part is linked to `robot`."""
        return any(j in live and robot in self._seen[j] for j in self._declared[robot])
