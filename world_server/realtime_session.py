"""The world's side of real time: readings out at every tick, the newest drives in, nobody waited for.

Rules: no clock, no socket; messages go in by `take_*`, the time is the world's tick. At every step the newest drive of
each robot counts, whatever tick it answers; one that is older than `realtime.drive_timeout` does not, and the robot
brakes. A robot that is lost brakes, too, and takes part again when it is seen again. A control period of a robot is
missed when no drive answers its reading before the next step. What is late or double is counted and dropped.

A planned crash or hang is done to the robot's process, and nothing else: that the robot is gone, and that it is back,
the world learns as it learns of unplanned ones.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import msgspec

from protocol.messages import Drive, Event, Halt, Inject, Reading, Resume
from world_server.faults.plan import CRASH
from world_server.session import ALL_STOPPED, CONTINUE, KILL, STOP, WorldSession
from world_server.world import World

_NOBODY: Mapping[int, Callable[[Resume], None]] = {}


class RealtimeWorldSession(WorldSession):
    """Drives a `World` through the ticks of a run that nobody holds up."""

    waits_for_returns = False

    def __init__(
        self,
        world: World,
        send: Mapping[int, Callable[[Reading], None]],
        halt: Callable[[Halt], None],
        tell: Callable[[Event], None],
        resume: Mapping[int, Callable[[Resume], None]] = _NOBODY,
        inject: Callable[[Inject], None] = lambda _: None,
    ) -> None:
        super().__init__(world, send, halt, tell, resume, inject)
        robots, timing = range(world.scenario.robots), world.scenario.timing
        self.missed = [0 for _ in robots]  # control periods without an answer, while the robot was not known to be lost
        self.braked = [False for _ in robots]
        self.slip = 0.0  # by how much the schedule on the wall clock has moved, s
        self.behind = 0.0  # furthest that the world was behind it, s
        self._newest: dict[int, Drive] = {}
        self._timeout_ticks = world.scenario.realtime.drive_timeout / timing.tick + 1e-6

    def take_drive(self, drive: Drive) -> bool:
        """Take a robot's drive if it is its newest; never is anything complete by it."""
        known = self._newest.get(drive.robot)
        if (
            self.ended is not None
            or drive.robot not in self.world.live
            or drive.tick > self.world.tick
            or (known is not None and drive.tick <= known.tick)
        ):
            self.dropped += 1
        else:
            self._newest[drive.robot] = drive
        return False

    def step(self) -> None:
        """Move the world to the next tick with the drives that count now, and say what the robots sense there."""
        world, now = self.world, self.world.tick
        self._drives = {}
        for i in range(world.scenario.robots):
            drive = self._newest.get(i)
            age = now - drive.tick if drive is not None else float("inf")
            alive = i in world.live
            if alive and age > 0:
                self.missed[i] += 1
            self.braked[i] = not alive or age > self._timeout_ticks
            if drive is not None and not self.braked[i]:
                self._drives[i] = drive
        world.bodies.brake(self.braked)
        super().step()

    def lose(self, robot: int, how: str = "lost") -> bool:
        """A robot is not heard of any more: it brakes until it is seen again. Nothing is ever complete by it."""
        world = self.world
        if robot in world.live and not (self.ended is not None and robot in self.reports):
            world.lose(robot)
            self.declarations.forget(robot)
            self._newest.pop(robot, None)
            if self.ended is None:
                self._note(f"robot {robot} {how} at {world.t:.2f} s", robot)
        return False

    def see(self, robot: int) -> None:
        """A robot is there again: it gets readings, and its drives count."""
        world = self.world
        if self.ended is None and 0 <= robot < world.scenario.robots and robot not in world.live:
            self.admit(robot)

    def suspend(self, robot: int, how: str) -> None:
        """A planned fault is due: let it be done to the robot's process."""
        self.stopped.add(robot)
        self._inject(Inject(robot, self.world.tick, KILL if how == CRASH else STOP))

    def call(self, robot: int) -> None:
        """A planned hang is over: let the robot's process go on."""
        self.stopped.discard(robot)
        self._inject(Inject(robot, self.world.tick, CONTINUE))

    def give_up_alone(self) -> None:
        """There has been no robot for too long: the run is over, unless one is to come back."""
        if not self.world.live and not self.plan.returns_after(self.world.tick):
            everybody = self.stopped.issuperset(range(self.world.scenario.robots))
            self.end(ALL_STOPPED if everybody else "all robots are gone")

    def _publish(self, readings: list[Reading]) -> None:
        for reading in readings:
            self._send[reading.robot](msgspec.structs.replace(reading, slip=self.slip) if self.slip else reading)
