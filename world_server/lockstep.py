"""Lock-step on the wires: events in, a step when all who take part have answered.

Rules: part of the shell. Every robot that is waited for answers, is lost, comes back or is given up, and what got lost
on the way is said again (`world_server.stall`), so that nothing waits for ever.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from math import gcd

from protocol import keys
from protocol.bus import Asked, Bus, BusEvent, Delivery, Lost, Seen
from protocol.messages import Drive, Linked, Progress, Stopped
from protocol.shell import settle_memory
from world_server.absences import Absences
from world_server.checkpoints import Checkpoints
from world_server.faults.slow import Slowness
from world_server.recoverable import RecoverableSession
from world_server.returns import Returns
from world_server.stall import AGAIN, Stall
from world_server.telemetry import Telemetry

PROGRESS_PERIOD = 0.1  # wall-clock s
POLL = 0.02  # s between two looks at what is not an event


@dataclass(slots=True)
class LockstepWorld:
    """The ticks of a run."""

    bus: Bus
    session: RecoverableSession
    telemetry: Telemetry | None
    progress: Callable[[Progress], None]
    pass_on: Callable[[Stopped], None]  # to the robots
    returns: Returns
    kept: Checkpoints | None
    start: float  # when the run began, s
    answer: Callable[[Asked], None]
    _absences: Absences = field(default_factory=Absences)
    _next_progress: float = 0.0
    _next_checkpoint: int = 0
    _alone: float | None = None  # since when nobody takes part and somebody may come, s

    def run(self) -> None:
        """Until the session is at its end."""
        session, world, returns = self.session, self.session.world, self.returns
        scenario, telemetry = world.scenario, self.telemetry
        # The field is advanced while the robots think, in batches that end where somebody looks at it.
        batch = world.ticks_per_sample if telemetry is None else gcd(world.ticks_per_sample, telemetry.field_ticks)
        sender = {keys.robot(i, keys.DRIVE): i for i in range(scenario.robots)}
        slow = Slowness(scenario)
        stall = Stall(scenario.network.return_timeout)
        self._next_checkpoint = self._due(world.tick)
        if not session.started:
            session.start()
        if telemetry is not None:
            telemetry.tick()
        world.prepare(batch - world.tick % batch)  # a world that came back may be anywhere in a batch
        settle_memory()
        receive, counters = self.bus.receive, self.bus.counters
        complete = False  # all who take part have answered
        while session.ended is None:
            complete = complete or session.idle
            looking = complete or session.awaited or self._deserted()
            event = receive(0 if session.idle else POLL if looking else AGAIN)
            if isinstance(event, Delivery) and isinstance(event.message, Drive):
                if sender[event.key] == event.message.robot:
                    complete = session.take_drive(event.message) or complete
                else:
                    counters.refused += 1
            elif event is not None:
                complete = self._take(event) or complete
            elif not complete and not session.deserted:
                complete = stall.look(session, time.monotonic())
            if session.awaited:
                returns.look(session)
            if complete and not returns.hold(session):
                complete = False
                self._step()
                if world.tick % batch == 0:
                    world.prepare(batch)
                if pause := slow.pause(world.tick):
                    time.sleep(pause)

    def _take(self, event: BusEvent) -> bool:
        """Take what is not a drive; whether all who take part have answered by it."""
        session = self.session
        if isinstance(event, Delivery):
            if isinstance(event.message, Linked) and keys.robot_of(event.key) == event.message.robot:
                session.take_linked(event.message)
            elif isinstance(event.message, Stopped):
                return self._take_stopped(event.message)
        elif isinstance(event, Lost):
            lost = keys.robot_of(event.name)
            return lost is not None and self._lose(lost)
        elif isinstance(event, Seen):
            seen = keys.robot_of(event.name)
            if seen is not None:
                self._see(seen)
        else:
            self.answer(event)
        return False

    def _lose(self, robot: int) -> bool:
        session, world = self.session, self.session.world
        if robot in world.live:
            self._absences.lost(robot, time.perf_counter(), world.t)
        return session.lose(robot)

    def _see(self, robot: int) -> None:
        if robot in self.session.awaited:
            self.session.call(robot)
        else:
            self.session.come(robot)

    def _take_stopped(self, order: Stopped) -> bool:
        """A robot's process stands still or goes on, as the launcher sees, long before its links fall silent for good."""
        self.pass_on(order)
        if not order.stopped:
            self._see(order.robot)
            return False
        if order.robot in self.session.world.live:
            self.returns.stopped(order.robot, self.session.world.tick)
        return self._lose(order.robot)

    def _step(self) -> None:
        session, world = self.session, self.session.world
        drove = world.live.copy()
        session.step()
        now = time.perf_counter()
        for robot, text in self._absences.stepped(drove, now, world.t):
            session.tell(text, robot)
        if self.telemetry is not None:
            self.telemetry.tick()
        if self.kept is not None and world.tick >= self._next_checkpoint and session.quiet:
            self._next_checkpoint = self._due(world.tick)
            self.kept.write(world.tick, world.snapshot(), session.snapshot(), now - self.start)
        if now >= self._next_progress:
            self._next_progress = now + PROGRESS_PERIOD
            self.progress(Progress(world.tick, world.t, len(world.live), world.detections, world.closest))

    def _due(self, tick: int) -> int:
        """The first tick after `tick` at which a checkpoint is due."""
        world = self.session.world
        every = max(1, round(world.scenario.supervision.checkpoint_every / world.dt))
        return (tick // every + 1) * every

    def _deserted(self) -> bool:
        """Whether the clock stands still for want of robots; for too long and the run is over."""
        session = self.session
        if not session.deserted:
            self._alone = None
            return False
        now = time.monotonic()
        if self._alone is None:
            self._alone = now
        elif now - self._alone > session.world.scenario.network.return_timeout:
            session.end("all robots are gone")
        return True
