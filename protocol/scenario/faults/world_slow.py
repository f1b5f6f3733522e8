"""A world that is slow to compute."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.scenario.faults.base import Passing


class WorldSlow(Passing, frozen=True, kw_only=True, tag="world-slow"):
    """The world's process sleeps `pause` seconds of wall clock at every tick; in lock-step the truth is the same."""

    pause: Annotated[float, Meta(gt=0, le=10)]  # s

    def about(self) -> str:
        return f"the world sleeps {self.pause:g} s at every tick{self.till}"
