"""A robot's process ends as by SIGKILL."""

from __future__ import annotations

from protocol.scenario.faults.base import Fault, RobotNumber
from protocol.scenario.table import NonNegative


class Crash(Fault, frozen=True, kw_only=True, tag="crash"):
    """Robot `robot` ends without a word: its body brakes, nobody hears it any more."""

    robot: RobotNumber
    restart: NonNegative = 0.0  # a new process takes its place after so many s; 0: never

    def about(self) -> str:
        again = f" and is started again after {self.restart:g} s" if self.restart else ""
        return f"robot {self.robot} crashes{again}"
