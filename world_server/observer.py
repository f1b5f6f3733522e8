"""Whoever looks at the truth as it unfolds: told of every step, and without any say.

Rules: an observer changes nothing; without one (the default) nothing is made or kept.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from protocol.messages import Drive, Reading


class Observer(Protocol):
    """What a `World` tells."""

    def stepped(self, drives: Mapping[int, Drive], *, sampled: bool) -> None:
        """It has moved to the next tick with these drives; `sampled`: the gas sensors did so, too."""
        ...

    def told(self, tick: int, readings: Sequence[Reading]) -> None:
        """What the live robots are about to be told at `tick`."""
        ...
