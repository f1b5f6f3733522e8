"""Whoever looks over a robot's shoulder: told at two places of every tick, and without any say.

Rules: an observer changes nothing; without one (the default) nothing is made or kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from protocol.messages import Drive, Shared
from robot_agent.interfaces import Decision, Fresh


class Observer(Protocol):
    """What an `Agent` tells."""

    def told(self, shared: Shared) -> None:
        """It has sensed; `shared` is what it is about to tell its neighbours."""
        ...

    def acted(
        self, heard: Sequence[Shared], fresh: Fresh, decision: Decision, mode: str, drive: Drive, *, begun: bool
    ) -> None:
        """It has acted.

        Args:
            heard: the states that arrived for this tick.
            fresh: the states that it used, with their weights.
            decision: as it is after the exchange with the neighbours.
            drive: what it is about to send.
            begun: whether it decides and fuses already.
        """
        ...
