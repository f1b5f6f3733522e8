"""A robot's sensor that is stuck, biased, dropped out or noisy."""

from __future__ import annotations

from typing import Literal

from protocol.scenario.faults.base import Passing, RobotNumber
from protocol.scenario.table import Real


class Sensor(Passing, frozen=True, kw_only=True, tag="sensor"):
    """What robot `robot` reads from one of its sensors is not what is there.

    `how`: "stuck" keeps the first value of the fault; "bias" adds `value` (on both axes); "noise" adds normal noise of
    standard deviation `value`; "dropout" loses each reading with probability `value`: concentration and wind read 0
    then, position and heading stay what they were.
    """

    robot: RobotNumber
    which: Literal["concentration", "wind", "position", "heading"]
    how: Literal["stuck", "bias", "dropout", "noise"]
    value: Real | None = None  # ppt, m/s, m, rad, or a probability; left out: 1 for "dropout", 0 otherwise

    @property
    def strength(self) -> float:
        """`value`, or what it is when it is left out."""
        return self.value if self.value is not None else float(self.how == "dropout")

    def about(self) -> str:
        words = {
            "stuck": "is stuck",
            "bias": f"is biased by {self.strength:g}",
            "dropout": f"drops out of {100 * self.strength:g} % of the readings",
            "noise": f"has noise of {self.strength:g}",
        }
        return f"robot {self.robot}'s {self.which} sensor {words[self.how]}{self.till}"
