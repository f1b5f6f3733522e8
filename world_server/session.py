"""The world's side of lock-step: readings out, drives in, a barrier that nobody dead can hold up.

Rules: no clock, no socket; messages go in by `take_*` and out by the publications given at the start. The world steps
when all live robots have answered; a robot that is lost leaves the barrier at once and its body brakes. What is late,
early, double or from a robot that is not alive is counted and dropped.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from protocol.messages import Drive, Event, Halt, Reading, Report
from world_server.declarations import Declarations
from world_server.world import World

FOUND, DECLARED, TIME_OUT, INTERRUPTED = "found", "declared", "time out", "interrupted"


class WorldSession:
    """Drives a `World` through the ticks of a run."""

    def __init__(
        self,
        world: World,
        send: Mapping[int, Callable[[Reading], None]],
        halt: Callable[[Halt], None],
        tell: Callable[[Event], None],
    ) -> None:
        self.world = world
        self.ended: str | None = None  # why the run is over
        self.reports: dict[int, Report] = {}
        self.dropped = 0
        self.faults: list[str] = []
        self._send = send
        self._halt = halt
        self._tell = tell
        self._drives: dict[int, Drive] = {}
        self._started = False
        self._by_word = world.scenario.declaration.stop == "declared"  # the swarm itself says when it is over
        self._reached = False
        self.declarations = Declarations()

    @property
    def over(self) -> bool:
        """Whether the run has ended and every live robot has said its last word."""
        return self.ended is not None and self.world.live <= self.reports.keys()

    def start(self) -> None:
        """Send the readings of tick 0."""
        self._started = True
        self._publish(self.world.readings())

    def take_drive(self, drive: Drive) -> bool:
        """Take a robot's answer; whether all live robots have answered now."""
        world = self.world
        if self.ended is not None or drive.tick != world.tick or drive.robot not in world.live:
            self.dropped += 1
            return False
        if drive.robot in self._drives:
            self.dropped += 1
            return False
        self._drives[drive.robot] = drive
        return len(self._drives) == len(world.live)

    def take_report(self, report: Report) -> None:
        """Take a robot's last word."""
        if self.ended is None or report.robot in self.reports:
            self.dropped += 1
        else:
            self.reports[report.robot] = report

    def step(self) -> None:
        """All live robots have answered: move the world to the next tick, and say what the robots sense there."""
        world = self.world
        drives, self._drives = self._drives, {}
        first = world.first_detection
        readings = world.step(world.t, world.next_t, drives)
        if first is None and world.first_detection is not None:
            self.tell("the odour is met for the first time", world.first_detector)
        if world.found is not None and not self._reached:
            self._reached = True
            self.tell("the source is reached" if self._by_word else "the source is found", world.found.robot)
        if self._reached and not self._by_word:
            self.end(FOUND)
        elif self._declared(drives):
            self.end(DECLARED)
        elif world.t >= world.scenario.max_time - 1e-9:
            self.end(TIME_OUT)
        else:
            self._publish(readings)

    def lose(self, robot: int, how: str = "lost") -> bool:
        """A robot is gone; whether all live robots have answered now."""
        world = self.world
        if robot not in world.live or (self.ended is not None and robot in self.reports):
            return False
        world.lose(robot)
        self._drives.pop(robot, None)
        if self.ended is None:
            text = f"robot {robot} {how} at {world.t:.2f} s"
            self.faults.append(text)
            self.tell(text, robot)
            if not world.live:
                self.end("all robots are gone")
                return False
        return self._started and self.ended is None and len(self._drives) == len(world.live)

    def end(self, why: str) -> None:
        """Finish the run."""
        if self.ended is None:
            self.ended = why
            self._halt(Halt(self.world.tick, why))

    def tell(self, text: str, robot: int = -1) -> None:
        """Note something that a person wants to know."""
        self._tell(Event(self.world.tick, self.world.t, robot, text))

    def _declared(self, drives: Mapping[int, Drive]) -> bool:
        """Whether every live robot told one and the same place."""
        world, declarations = self.world, self.declarations
        for robot, (_, by, x, y) in declarations.take(drives.values()):
            if robot == by:
                self.tell(f"declares the source at ({x:.2f}, {y:.2f})", robot)
        agreed = self._by_word and declarations.agreed(world.live, world.t)
        if agreed:
            self.tell("all robots declare the same place")
        return agreed

    def _publish(self, readings: list[Reading]) -> None:
        for reading in readings:
            self._send[reading.robot](reading)
