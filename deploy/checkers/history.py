"""What the members of a run wrote down, put together for the checkers.

Rules: reading repairs nothing and judges nothing. A world that began again from a checkpoint has gone back in time: what
it had done after that tick is replaced by what it did instead. Robots that began again have several lives.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import msgspec

from protocol import keys
from protocol.errors import ScenarioError
from protocol.history.file import SUFFIX, HistoryMemory, records_in
from protocol.history.records import VERSION, Acted, Begin, Mind, Moved, Record, Result, Sent, Told, Verdict
from protocol.scenario import Scenario


@dataclass(slots=True)
class Life:
    """One robot from a start of its process to the next."""

    robot: int
    fuses: bool
    sent: list[Sent] = field(default_factory=list)
    acted: list[Acted] = field(default_factory=list)  # `mind` is always there


@dataclass(slots=True)
class History:
    """All that was written down of one run."""

    scenario: Scenario
    lives: dict[int, list[Life]]  # by robot
    moved: list[Moved] = field(default_factory=list)
    told: dict[int, Told] = field(default_factory=dict)  # by tick
    verdicts: list[Verdict] = field(default_factory=list)
    results: list[Result] = field(default_factory=list)

    @property
    def dt(self) -> float:
        """Length of a tick, s."""
        return self.scenario.timing.tick

    def acts(self) -> Iterator[tuple[Life, Acted]]:
        """Everything that any robot did, tick by tick, within a tick by robot."""
        all_of_them = [(act.tick, life.robot, n, act, life) for n, life in self._numbered() for act in life.acted]
        all_of_them.sort(key=lambda entry: entry[:3])
        for _, _, _, act, life in all_of_them:
            yield life, act

    def sent(self) -> dict[tuple[int, int], list[Sent]]:
        """What each robot told its neighbours, by (robot, tick): more than one when it lived through a tick twice."""
        said: dict[tuple[int, int], list[Sent]] = {}
        for _, life in self._numbered():
            for state in life.sent:
                said.setdefault((life.robot, state.tick), []).append(state)
        return said

    def when(self, tick: int) -> str:
        """A tick in words."""
        return f"at tick {tick} ({tick * self.dt:.2f} s)"

    def _numbered(self) -> Iterator[tuple[int, Life]]:
        return ((n, life) for lives in self.lives.values() for n, life in enumerate(lives))


def read_folder(folder: Path) -> History:
    """The history in `folder`, as `odourswarm run --history` leaves it.

    Raises: ScenarioError when there is none, or it is damaged.
    """
    if not folder.is_dir():
        raise ScenarioError(f"{folder}: there is no such folder; make a history with `odourswarm run --history DIR`.")
    files = sorted(folder.glob(f"*{SUFFIX}"))
    if not files:
        raise ScenarioError(f"{folder}: there is no history in it; make one with `odourswarm run --history DIR`.")
    return _put_together({str(file): file.read_bytes() for file in files}, str(folder))


def read_memory(histories: HistoryMemory) -> History:
    """The history of a run that was kept in memory."""
    return _put_together(histories.members, "the history in memory")


def _put_together(files: Mapping[str, bytes | bytearray], where: str) -> History:
    robots: dict[int, list[Life]] = {}
    world: list[Record] = []
    runs: set[str] = set()
    for name, data in files.items():
        records = list(records_in(bytes(data), name))
        if not records:
            continue  # killed before it had begun
        first = records[0]
        if not isinstance(first, Begin) or first.version != VERSION:
            raise ScenarioError(f"{name}: it is not a history of this version of odourswarm; make the history again.")
        runs |= {record.run for record in records if isinstance(record, Begin)}
        robot = keys.robot_of(first.member)
        if robot is None:
            world = records
        else:
            robots[robot] = list(_lives(robot, records))
    if not world or not isinstance(world[0], Begin):
        raise ScenarioError(f"{where}: the world's history is not there; put the files of all members into one folder.")
    if len(runs) > 1:
        raise ScenarioError(f"{where}: these are files of the runs {', '.join(sorted(runs))}; keep one run in a folder.")
    try:
        scenario = msgspec.json.decode(world[0].scenario, type=Scenario)
    except msgspec.MsgspecError as error:
        raise ScenarioError(f"{where}: its scenario is none that this version knows ({error}).") from None
    history = History(scenario, {robot: robots[robot] for robot in sorted(robots)})
    _take_world(history, world)
    return history


def _lives(robot: int, records: Iterable[Record]) -> Iterator[Life]:
    life: Life | None = None
    mind: Mind | None = None
    for record in records:
        if isinstance(record, Begin):
            if life is not None:
                yield life
            life, mind = Life(robot, record.fuses), None
        elif life is not None and isinstance(record, Sent):
            life.sent.append(record)
        elif life is not None and isinstance(record, Acted):
            mind = record.mind if record.mind is not None else mind
            life.acted.append(msgspec.structs.replace(record, mind=mind))
    if life is not None:
        yield life


def _take_world(history: History, records: Iterable[Record]) -> None:
    begins = False
    for record in records:
        if isinstance(record, Begin):
            begins = True
        elif isinstance(record, Moved):
            if begins:
                history.moved = [each for each in history.moved if each.tick < record.tick]
                history.told = {k: each for k, each in history.told.items() if k <= record.tick}
                begins = False
            history.moved.append(record)
        elif isinstance(record, Told):
            history.told[record.tick] = record
        elif isinstance(record, Verdict):
            history.verdicts.append(record)
        elif isinstance(record, Result):
            history.results.append(record)
