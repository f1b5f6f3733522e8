"""A robot's process stands still as between SIGSTOP and SIGCONT."""

from __future__ import annotations

from protocol.scenario.faults.base import Passing, RobotNumber


class Hang(Passing, frozen=True, kw_only=True, tag="hang"):
    """Robot `robot` stands still: its body brakes, it neither hears nor is heard; then it goes on with what it knew."""

    robot: RobotNumber

    def about(self) -> str:
        return f"robot {self.robot} hangs{self.till}"
