"""What the robots declared, as the world hears it with their drives.

Rules: pure; the swarm has declared when every live robot tells the same declaration. The world only listens: nothing of
this goes back to a robot.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from math import hypot

from protocol.messages import DeclaredRecord, Drive

WRONG = 2.0  # a place further from the source than this is a false declaration, m


class Declarations:
    """The newest declaration that each robot told, and the common one."""

    def __init__(self) -> None:
        self.of: dict[int, DeclaredRecord] = {}  # by robot
        self.common: DeclaredRecord | None = None
        self.at: float | None = None  # when all live robots told it, s

    def take(self, drives: Iterable[Drive]) -> Iterator[tuple[int, DeclaredRecord]]:
        """Take the robots' answers of a tick; what is new in them, by robot."""
        for drive in sorted(drives, key=lambda drive: drive.robot):
            record = drive.declared
            if record is not None and self.of.get(drive.robot) != record:
                self.of[drive.robot] = record
                yield drive.robot, record

    def forget(self, robot: int) -> None:
        """`robot` does not take part any more; should it come back, it says again what it knows."""
        self.of.pop(robot, None)

    def agreed(self, live: Collection[int], t: float) -> bool:
        """Whether all of `live` have told the same by time `t`, s."""
        if self.common is None and live:
            told = {self.of.get(robot) for robot in live}
            if len(told) == 1 and (common := told.pop()) is not None:
                self.common, self.at = common, t
        return self.common is not None

    def error(self, source: tuple[float, float] | None) -> float | None:
        """Distance of the common place from the source, m; None without either."""
        if self.common is None or source is None:
            return None
        return hypot(self.common[2] - source[0], self.common[3] - source[1])
