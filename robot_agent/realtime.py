"""A robot's part in a real-time run: whatever has arrived is taken in, then the newest reading is answered.

Rules: this shell owns the wall clock and the wait; what counts is decided in `RealtimeRobotSession`. It waits for events
only, never for a particular robot: who hangs, hangs alone. A world that is not heard of any more may come back, as after
a hang of this very process; without it the robot gives up after `realtime.alone`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from protocol import keys
from protocol.bus import Bus, BusEvent, Delivery, Lost, Seen
from protocol.errors import SwarmFailure
from protocol.messages import Drive, Halt, Reading, Report, Shared, Stopped
from protocol.scenario import RobotScenario
from protocol.shell import settle_memory
from robot_agent.agent import Agent
from robot_agent.realtime_session import RealtimeRobotSession
from robot_agent.report import report

FAREWELL = 2.0  # s that a robot waits for the world to close after its report
AT_A_TIME = 1000  # events taken in before a reading is answered: a flood must not keep a robot from driving


def realtime_session(
    agent: Agent, view: RobotScenario, tell: Callable[[Shared], None], drive: Callable[[Drive], None]
) -> RealtimeRobotSession:
    """The session of `view`, its simulated times brought to the wall clock."""
    speed, timing = view.realtime.speed, view.timing
    return RealtimeRobotSession(
        agent,
        tell,
        drive,
        period=timing.tick / speed,
        late=view.realtime.late / speed,
        ahead=max(1, round(timing.stale_after / timing.tick)),
    )


@dataclass(slots=True)
class RealtimePart:
    """One robot between its first reading and its last word."""

    bus: Bus
    session: RealtimeRobotSession
    sender: Mapping[str, int]  # key -> the neighbour that speaks under it
    last_word: Callable[[Report], None]
    alone: float  # s without the world until it gives up
    say: Callable[[str], None]
    _halted: bool = False
    _left: bool = False  # the world has closed after the end
    _alone_until: float | None = None

    def take_part(self) -> None:
        """Drive until the run is over and the world has gone.

        Raises: SwarmFailure when the world goes before that, and stays away.
        """
        settle_memory()
        receive, session, clock = self.bus.receive, self.session, time.monotonic
        while True:
            event = receive(self._patience(clock()))
            if event is None and self._halted:
                return
            left = AT_A_TIME
            while event is not None:
                self._take(event)
                left -= 1
                event = receive(0) if left else None
            if self._left:
                return
            now = clock()
            if not self._halted:
                session.respond(now)
                if self._alone_until is not None and now >= self._alone_until:
                    raise SwarmFailure(f"robot {session.agent.robot}: the world is gone at tick {session.tick}.")

    def _patience(self, now: float) -> float | None:
        if self._halted:
            return FAREWELL
        return None if self._alone_until is None else max(0.0, self._alone_until - now)

    def _take(self, event: BusEvent) -> None:
        if isinstance(event, Delivery):
            message = event.message
            if isinstance(message, Shared):
                if self.sender[event.key] == message.robot:
                    self.session.take_shared(message)
                else:
                    self.bus.counters.refused += 1
            elif isinstance(message, Reading):
                self.session.take_reading(message)
            elif isinstance(message, Stopped):
                if message.robot in self.sender.values():
                    self.say(f"{keys.robot_name(message.robot)} is {'lost' if message.stopped else 'there'}")
            elif isinstance(message, Halt) and not self._halted:
                self._halted = True
                self.say(f"the run is over: {message.reason}; {self.session.missed} control periods were missed")
                self.last_word(report(self.session, self.bus.counters))
        elif isinstance(event, Lost):
            if event.name == keys.WORLD:
                self._left = self._halted
                self._alone_until = time.monotonic() + self.alone
            self.say(f"{event.name} is lost")
        elif isinstance(event, Seen):
            if event.name == keys.WORLD:
                self._alone_until = None
            self.say(f"{event.name} is there")
