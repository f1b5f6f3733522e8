"""A wheel that is weak."""

from __future__ import annotations

from typing import Literal

from protocol.scenario.faults.base import Passing, RobotNumber
from protocol.scenario.table import Fraction


class Actuator(Passing, frozen=True, kw_only=True, tag="actuator"):
    """A wheel of robot `robot` gives `strength` times the torque that it would give."""

    robot: RobotNumber
    wheel: Literal["left", "right", "both"]
    strength: Fraction

    def about(self) -> str:
        wheel = "both wheels have" if self.wheel == "both" else f"{self.wheel} wheel has"
        return f"robot {self.robot}'s {wheel} {100 * self.strength:g} % of the torque{self.till}"
