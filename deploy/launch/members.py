"""How each member of a run is started: module, flags, and what it is handed over.

Rules: a member on this machine reads a file in the run's folder; one that has a seat on a host is started through the
host's command, and reads the same from the pipe that is its leash, so that nothing has to be there before it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import msgspec

from deploy.hosts.seats import Seats
from deploy.launch.children import Children
from protocol import keys
from protocol.scenario import Scenario
from protocol.scenario.place import WorldPlace, place_of


@dataclass(frozen=True, slots=True)
class Members:
    """World, robots and recorder of one run."""

    run: str
    scenario: Scenario
    endpoints: tuple[str, ...]  # the world's, then each robot's
    folder: Path  # the run's own, on this machine
    children: Children
    seats: Seats | None = None  # none: everybody is on this machine
    history: Path | None = None
    checkpoints: Path | None = None
    record: Path | None = None
    view: bool = False

    @property
    def recorded(self) -> bool:
        """Whether there is a recorder."""
        return self.record is not None or self.view

    def start_all(self) -> None:
        """Start everybody."""
        (self.folder / "scenario.json").write_bytes(msgspec.json.encode(self.scenario))
        (self.folder / "endpoints.json").write_bytes(msgspec.json.encode(self.endpoints))
        for name in (keys.WORLD, *map(keys.robot_name, range(self.scenario.robots))):
            self.start(name)
        if self.recorded:
            output = ["--record", str(self.record)] if self.record is not None else []
            flags = ["--run", self.run, "--folder", str(self.folder), *output, *(["--view"] if self.view else [])]
            self.children.start("recorder", "deploy.recorder", flags)

    def start(self, name: str, *, again: bool = False) -> None:
        """Start the world or a robot; `again`: its process has ended, and the run has begun."""
        robot = keys.robot_of(name)
        if robot is None:
            self._start(name, "world_server", self._world_flags(), WorldPlace(self.scenario, self.endpoints))
        else:
            place = place_of(self.scenario, robot, self.endpoints)
            self._start(name, "robot_agent", [*self._history(), *(["--rejoin"] if again else [])], place)

    def _start(self, name: str, module: str, flags: list[str], given: object) -> None:
        flags, handed = ["--run", self.run, *flags], msgspec.json.encode(given)
        if self.seats is not None:
            seat = self.seats.members[name]
            flags += ["--place", "-"]
            self.children.start(name, module, flags, through=seat.through, python=seat.python, handed=handed)
        elif name == keys.WORLD:
            self.children.start(name, module, [*flags, "--folder", str(self.folder)])
        else:
            file = self.folder / f"place-{keys.robot_of(name)}.json"
            file.write_bytes(handed)
            self.children.start(name, module, [*flags, "--place", str(file)])

    def _world_flags(self) -> list[str]:
        flags = ["--launcher", *(["--recorder"] if self.recorded else []), *self._history()]
        if self.scenario.supervision.checkpoint_every:
            flags += ["--checkpoints", str(self.checkpoints or self.folder)]
        return flags

    def _history(self) -> list[str]:
        return ["--history", str(self.history)] if self.history is not None else []
