"""One record per robot, passed on from neighbour to neighbour: the newest that anybody has of each.

Rules: a record is (robot, time, what else); only the robot itself makes its records, and the newest one replaces the
others wherever it comes, so that everybody knows the same after as many exchanges as the graph is wide, on any connected
graph, and the records of a robot that is gone stay. Hearing one twice or late changes nothing. Records are told once a
decision, to keep the messages of the other ticks small.
"""

from __future__ import annotations

from collections.abc import Iterator

from protocol.messages import MAX_RECORDS
from protocol.scenario import RobotScenario
from robot_agent.hand import Own
from robot_agent.interfaces import Fresh

Record = tuple[float, ...]


class Gossip:
    """One robot's records of all."""

    def __init__(self, scenario: RobotScenario, width: int) -> None:
        """`width`: numbers of a record."""
        self._width = width
        self._ticks_per_decision = round(scenario.timing.decision / scenario.timing.tick)
        self._records: dict[int, Record] = {}

    def offer(self, record: Record) -> bool:
        """Take a record when it is newer than what is known of its robot; whether it was."""
        robot = int(record[0])
        known = self._records.get(robot)
        if known is not None and record[1] <= known[1]:
            return False
        self._records[robot] = record
        return True

    def hear(self, fresh: Fresh) -> Iterator[Record]:
        """Take what the neighbours tell; the records that were new, in an order that is the same in every process."""
        width = self._width
        for _, state in sorted(fresh, key=lambda pair: pair[1].robot):
            notes = state.notes
            for start in range(0, len(notes) - width + 1, width):
                record = notes[start : start + width]
                if self.offer(record):
                    yield record

    def records(self) -> list[Record]:
        """All that is known, by robot number."""
        return [self._records[robot] for robot in sorted(self._records)]

    def notes(self, own: Own) -> tuple[float, ...]:
        """All records in one row, at decisions; the newest ones when they are more than a message holds."""
        if not own.due(self._ticks_per_decision):
            return ()
        known = self.records()
        if len(known) * self._width > MAX_RECORDS:
            known = sorted(known, key=lambda record: -record[1])[: MAX_RECORDS // self._width]
        return tuple(number for record in known for number in record)
