"""One robot in real time: it acts on what it has when a reading comes, and waits for nobody.

Rules: no clock, no socket; messages go in by `take_*`, the time is an argument of `respond`. The newest reading counts,
older ones are skipped: control periods that were missed. A robot whose reading is late keeps a safe stop: it tells and
drives nothing, so that its neighbours forget it and the world brakes it. Of the neighbours whom the reading lets it
hear it uses the newest state each has sent; how old one may be is the agent's business (`timing.stale_after`). What is
late, double or out of place is counted and dropped; nothing raises.
"""

from __future__ import annotations

from collections.abc import Callable

import msgspec

from protocol.messages import Drive, Reading, Shared
from robot_agent.agent import Agent
from robot_agent.lateness import Lateness

MAX_HEARD = 4096  # states kept between two readings


class RealtimeRobotSession:
    """Drives an `Agent` at the pace of its readings."""

    def __init__(
        self,
        agent: Agent,
        tell: Callable[[Shared], None],
        drive: Callable[[Drive], None],
        *,
        period: float,
        late: float,
        ahead: int,
    ) -> None:
        """
        Args:
            period: between two readings, wall-clock s.
            late: a reading that is later keeps the robot in its safe stop, wall-clock s.
            ahead: a neighbour's state that is more ticks ahead of the last reading is not believed.
        """
        self.agent = agent
        self.tick = -1  # of the newest reading
        self.dropped = 0
        self.missed = 0  # control periods: readings that were skipped, or too late to be answered
        self.stopped = False  # in the safe stop
        self._tell = tell
        self._drive = drive
        self._late = late
        self._ahead = ahead
        self._lateness = Lateness(period)
        self._pending: Reading | None = None
        self._wind_past: tuple[tuple[float, float], ...] = ()  # told with the first reading, which may be skipped
        self._answered = -1  # tick of the last reading that was used
        self._heard: list[Shared] = []  # since then
        self._newest: dict[int, int] = {}  # neighbour -> tick of its newest state
        self._notes: dict[int, tuple[float, ...]] = {}  # the last that each neighbour told

    def take_reading(self, reading: Reading) -> None:
        """Take a reading if it is the newest."""
        if reading.robot != self.agent.robot or reading.tick <= self.tick:
            self.dropped += 1
            return
        self.tick = reading.tick
        self._pending = reading
        self._wind_past = reading.wind_past or self._wind_past

    def take_shared(self, state: Shared) -> None:
        """Take a neighbour's state, for the next reading."""
        newest = self._newest.get(state.robot, -1)
        if state.tick == newest or state.tick > self.tick + self._ahead or len(self._heard) >= MAX_HEARD:
            self.dropped += 1
            return
        if state.tick > newest:
            self._newest[state.robot] = state.tick
            if state.notes:
                self._notes[state.robot] = state.notes
            elif (notes := self._notes.get(state.robot)) is not None:
                # Notes are told once a decision only; a robot that decides at other instants must not miss them.
                state = msgspec.structs.replace(state, notes=notes)
        self._heard.append(state)

    def respond(self, now: float) -> bool:
        """Answer the newest reading, if there is a new one; whether the robot drives."""
        reading, self._pending = self._pending, None
        if reading is None:
            return False
        self.missed += reading.tick - self._answered - 1 if self._answered >= 0 else 0
        self._answered = reading.tick
        self.stopped = self._lateness.of(reading.tick, reading.slip, now) > self._late
        if self.stopped:
            self.missed += 1
            return False
        hears = {j for j, _ in reading.hears}
        heard, self._heard = [s for s in self._heard if s.robot in hears], []
        if self._wind_past:
            reading, self._wind_past = msgspec.structs.replace(reading, wind_past=self._wind_past), ()
        self._tell(self.agent.sense(reading))
        self._drive(self.agent.act(heard))
        return True
