"""A robot whose clock is wrong."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.scenario.faults.base import Passing, RobotNumber
from protocol.scenario.table import Real


class ClockSkew(Passing, frozen=True, kw_only=True, tag="clock-skew"):
    """Robot `robot` believes that it is t + `offset` + `drift` (t - `at`), and tells times by that clock."""

    robot: RobotNumber
    offset: Real = 0.0  # s
    drift: Annotated[float, Meta(ge=-1, le=10)] = 0.0  # s/s

    def about(self) -> str:
        return f"robot {self.robot}'s clock is {self.offset:+g} s off and drifts by {self.drift:+g} s/s{self.till}"
