"""The world of a real-time run: it steps when the wall clock says so, whoever has answered.

Rules: this shell owns the wall clock and the wait; when a step is due is decided by `Pace`, what counts in it by
`RealtimeWorldSession`. Nobody is waited for. The plume is advanced step by step right after the readings have gone out,
while the robots think.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from protocol import keys
from protocol.bus import Asked, Bus, BusEvent, Delivery, Lost, Seen
from protocol.messages import Drive, Progress, Stopped
from protocol.scenario.faults import Crash, Hang
from protocol.shell import settle_memory
from world_server.faults.slow import Slowness
from world_server.pace import Pace
from world_server.realtime_session import RealtimeWorldSession
from world_server.telemetry import Telemetry

PROGRESS_PERIOD = 0.1  # s
COMPLAINT_PERIOD = 10.0  # s between two words about a schedule that moves,
WORTH_A_WORD = 0.1  # when it has moved by so many s since
AT_A_TIME = 5000  # events taken in before a step that is due: a flood must not hold up the clock


@dataclass(slots=True)
class RealtimeWorld:
    """The ticks of a run by the wall clock."""

    bus: Bus
    session: RealtimeWorldSession
    telemetry: Telemetry | None
    progress: Callable[[Progress], None]
    pass_on: Callable[[Stopped], None]  # to the robots
    answer: Callable[[Asked], None]  # to a robot that joins late
    launcher: bool  # there is one, to make robots crash and hang

    def run(self) -> None:
        """From the first reading to the end of the run."""
        session, clock = self.session, time.monotonic
        world = session.world
        realtime, tick = world.scenario.realtime, world.dt
        sender = {keys.robot(i, keys.DRIVE): i for i in range(world.scenario.robots)}
        receive = self.bus.receive
        slow = Slowness(world.scenario)
        if not self.launcher and any(isinstance(fault, Crash | Hang) for fault in world.scenario.faults):
            session.tell("no launcher: nobody makes robots crash or hang as planned")
        world.prepare()
        settle_memory()
        begun = clock()
        pace = Pace(begun, tick / realtime.speed, realtime.catch_up / realtime.speed)
        next_progress, next_complaint, told, alone_since = 0.0, begun, 0.0, None
        session.start()
        if self.telemetry is not None:
            self.telemetry.tick()
        while session.ended is None:
            event = receive(pace.wait(clock()))
            left = AT_A_TIME
            while event is not None:
                self._take(event, sender)
                left -= 1
                event = receive(0) if left else None
            now = clock()
            if pace.wait(now) > 0.0:
                continue
            pace.step(now)
            session.slip, session.behind = pace.slip, pace.behind
            session.step()
            if self.telemetry is not None:
                self.telemetry.tick()
            world.prepare()
            if pause := slow.pause(world.tick):
                time.sleep(pause)
            if pace.slip - told > WORTH_A_WORD and now >= next_complaint:
                next_complaint, told = now + COMPLAINT_PERIOD, pace.slip
                session.tell(f"the world cannot keep up: it has given up {pace.slip:.3f} s of the wall clock so far")
            alone_since = None if world.live else alone_since or now
            if alone_since is not None and now - alone_since > realtime.alone:
                session.give_up_alone()
            if now >= next_progress:
                next_progress = now + PROGRESS_PERIOD
                self.progress(Progress(world.tick, world.t, len(world.live), world.detections, world.closest))

    def _take(self, event: BusEvent, sender: dict[str, int]) -> None:
        if isinstance(event, Delivery):
            message = event.message
            if isinstance(message, Drive):
                if sender[event.key] == message.robot:
                    self.session.take_drive(message)
                else:
                    self.bus.counters.refused += 1
            elif isinstance(message, Stopped):
                self.pass_on(message)
                if message.stopped:
                    self.session.lose(message.robot)
                else:
                    self.session.see(message.robot)
        elif isinstance(event, Lost):
            if (lost := keys.robot_of(event.name)) is not None:
                self.session.lose(lost)
        elif isinstance(event, Seen):
            if (seen := keys.robot_of(event.name)) is not None:
                self.session.see(seen)
        elif isinstance(event, Asked):
            self.answer(event)
