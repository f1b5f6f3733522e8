"""The table of real time: how fast the world's clock goes, and how old is too old.

Rules: none of it is from the thesis, whose simulations wait for every robot. "Simulated s" shrink with `speed` on the
wall clock; nothing of this counts in lock-step.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.scenario.table import NonNegative, Positive, Table


class Realtime(Table, frozen=True):
    """The clock of `clock = "realtime"`."""

    speed: Annotated[float, Meta(ge=0.01, le=1000)] = 1.0  # simulated s per s on the wall clock
    drive_timeout: Positive = 0.25  # the world brakes a robot whose drive is older, simulated s
    late: Positive = 0.25  # a robot whose reading is later keeps a safe stop, simulated s
    catch_up: NonNegative = 0.1  # a world that is further behind the wall clock moves its schedule, simulated s
    alone: Positive = 3.0  # without any robot the world, without the world a robot gives up after this, wall-clock s
