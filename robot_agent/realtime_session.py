"""One robot in real time: it acts on what it has when a reading comes, and waits for nobody.

Rules: no clock, no socket; messages go in by `take_*`, the time is an argument of `respond`. The newest reading counts,
older ones are skipped: control periods that were missed. A robot whose reading is late keeps a safe stop: it tells and
drives nothing, so that its neighbours forget it and the world brakes it. Of each neighbour it uses the newest state that
the radio lets through; how old that may be is the agent's business (`timing.stale_after`). What is late, double or out
of place is counted and dropped; nothing raises.
"""

from __future__ import annotations

from collections.abc import Callable

import msgspec

from protocol.messages import Drive, Reading, Shared
from robot_agent.agent import Agent
from robot_agent.faults import false_sense
from robot_agent.lateness import Lateness
from robot_agent.reception import Reception


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
        self._sense = false_sense(agent)
        self._tell = tell
        self._drive = drive
        self._late = late
        self._ahead = ahead
        self._lateness = Lateness(period)
        self._reception = Reception()
        self._pending: Reading | None = None
        self._wind_past: tuple[tuple[float, float], ...] = ()  # told with the first reading, which may be skipped
        self._answered = -1  # tick of the last reading that was used
        self._notes: dict[int, tuple[float, ...]] = {}  # the last that each neighbour told

    def take_reading(self, reading: Reading) -> None:
        """Take a reading if it is the newest."""
        if reading.robot != self.agent.robot or reading.tick <= self.tick:
            self.dropped += 1
            return
        self.tick = reading.tick
        self._pending = reading
        self._wind_past = reading.wind_past or self._wind_past
        self._reception.allow(reading)

    def take_shared(self, state: Shared) -> None:
        """Take a neighbour's state, for the next reading."""
        if state.tick > self.tick + self._ahead or not self._reception.take(state, self.tick):
            self.dropped += 1

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
        if self._wind_past:
            reading, self._wind_past = msgspec.structs.replace(reading, wind_past=self._wind_past), ()
        self._tell(self._sense(reading))
        heard = [self._with_notes(state) for state in self._reception.heard(reading.tick)]
        self._drive(self.agent.act(heard))
        return True

    def _with_notes(self, state: Shared) -> Shared:
        """Notes are told once a decision only; a robot that decides at another instant must not miss them."""
        if state.notes:
            self._notes[state.robot] = state.notes
        elif (notes := self._notes.get(state.robot)) is not None:
            return msgspec.structs.replace(state, notes=notes)
        return state
