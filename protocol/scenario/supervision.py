"""The table of supervision: who is started again when its process ends, how often, and how long others wait for it.

Rules: nothing of this is in the thesis, and nothing of it decides a run whose processes live: it is no part of the
scenario's digest. All times but `checkpoint_every` are on the wall clock.
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from protocol.scenario.table import NonNegative, Positive, Table


class Supervision(Table, frozen=True):
    """What the launcher does about processes that end during the run."""

    restart: Literal["never", "always", "crashed"] = "never"  # a robot: never, whenever it ends, or when it did not end well
    backoff: Positive = 0.5  # before the second restart within `window`, s; twice that before the next; the first is at once
    max_backoff: Positive = 10.0  # s
    max_restarts: Annotated[int, Meta(ge=0, le=1000)] = 5  # of one process within `window`; then it is given up
    window: Positive = 60.0  # s
    checkpoint_every: NonNegative = 0.0  # simulated s between two checkpoints of the world; 0: none, it cannot come back
    world_within: Positive = 20.0  # robots wait so long for a world that has checkpoints to come back, s
