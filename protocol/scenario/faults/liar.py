"""A robot that tells its neighbours what is not so, in its own name."""

from __future__ import annotations

from typing import Literal

from protocol.scenario.faults.base import Passing, RobotNumber
from protocol.scenario.table import NonNegative, Point


class Liar(Passing, frozen=True, kw_only=True, tag="liar"):
    """Robot `robot` believes and does what is right and tells something else.

    `lies` is what about. Its fusion state, its hand position or its decision are moved by `offset` and by normal noise of
    standard deviation `noise` per axis (with its fusion state also its word, which it always gives as new); "detection":
    it says that it smells `ppt` now, at its place plus `offset`.
    """

    robot: RobotNumber
    lies: Literal["fusion", "detection", "position", "decision"] = "fusion"
    offset: Point = (0.0, 0.0)  # m
    noise: NonNegative = 0.0  # m
    ppt: NonNegative = 10000.0  # for "detection"

    def about(self) -> str:
        x, y = self.offset
        words = f" by ({x:g}, {y:g}) m" if self.lies != "detection" else f": {self.ppt:g} ppt"
        noise = f" with noise of {self.noise:g} m" if self.noise else ""
        return f"robot {self.robot} lies about its {self.lies}{words}{noise}{self.till}"
