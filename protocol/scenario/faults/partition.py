"""Groups of robots that do not hear each other."""

from __future__ import annotations

from protocol.scenario.faults.base import Passing, RobotNumber


class Partition(Passing, frozen=True, kw_only=True, tag="partition"):
    """Nothing passes between the groups; robots that are in none of them are one more group.

    `one_way`: a group still hears those before it in the list, but not those after it.
    """

    groups: tuple[tuple[RobotNumber, ...], ...]
    one_way: bool = False

    def group_of(self, robot: int) -> int:
        """Which group `robot` is in; robots of no group are in the last one."""
        return next((n for n, group in enumerate(self.groups) if robot in group), len(self.groups))

    def parts(self, i: int, j: int) -> bool:
        """Whether it keeps robot i from hearing robot j."""
        mine, theirs = self.group_of(i), self.group_of(j)
        return mine < theirs if self.one_way else mine != theirs

    def about(self) -> str:
        groups = " | ".join(" ".join(map(str, group)) for group in self.groups)
        return f"the robots are parted, {groups}{' (one way)' if self.one_way else ''}{self.till}"
