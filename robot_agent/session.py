"""One robot's lock-step: reading in, shared state out, neighbours' states in, drive out.

Rules: no clock, no socket; messages go in by `take_*` and out by the two publications given at the start. A reading
says which (neighbour, tick) states to wait for; the session waits for exactly these, and a neighbour that is lost is
not waited for. What is late, early, double or not asked for is counted and dropped; nothing raises.
"""

from __future__ import annotations

from collections.abc import Callable

from protocol.messages import Drive, Reading, Shared
from robot_agent.agent import Agent

HISTORY = 64  # ticks that a neighbour's state is kept, for readings that ask for an older one (radio delay)


class RobotSession:
    """Drives an `Agent` through the ticks of a run."""

    def __init__(self, agent: Agent, tell: Callable[[Shared], None], drive: Callable[[Drive], None]) -> None:
        self.agent = agent
        self.tick = -1
        self.dropped = 0
        self._tell = tell
        self._drive = drive
        self._states: dict[int, dict[int, Shared]] = {}  # tick -> neighbour -> its state
        self._hears: tuple[tuple[int, int], ...] = ()
        self._missing: set[tuple[int, int]] = set()
        self._acting = False

    @property
    def waiting(self) -> bool:
        """Whether the session waits for states of neighbours."""
        return self._acting

    def take_reading(self, reading: Reading) -> bool:
        """Begin the next tick; whether the tick was finished at once."""
        if reading.robot != self.agent.robot or reading.tick != self.tick + 1 or self._acting:
            self.dropped += 1
            return False
        self.tick = reading.tick
        self._states.pop(self.tick - HISTORY, None)
        self._tell(self.agent.sense(reading))
        self._hears = reading.hears
        states = self._states
        self._missing = {(j, k) for j, k in reading.hears if j not in states.get(k, ())}
        self._acting = True
        return self._finish_if_complete()

    def take_shared(self, state: Shared) -> bool:
        """Take a neighbour's state; whether that finished the tick."""
        # A neighbour can be one tick ahead: the world may have sent it the next reading first.
        if not self.tick - HISTORY < state.tick <= self.tick + 1:
            self.dropped += 1
            return False
        of_tick = self._states.setdefault(state.tick, {})
        if state.robot in of_tick:
            self.dropped += 1
            return False
        of_tick[state.robot] = state
        if self._acting and self._missing:
            self._missing.discard((state.robot, state.tick))
            return self._finish_if_complete()
        return False

    def lose(self, robot: int) -> bool:
        """A neighbour is gone: do not wait for it; whether that finished the tick."""
        if not self._acting:
            return False
        self._missing = {(j, k) for j, k in self._missing if j != robot}
        return self._finish_if_complete()

    def _finish_if_complete(self) -> bool:
        if self._missing:
            return False
        states = self._states
        heard = [states[k][j] for j, k in self._hears if j in states.get(k, ())]
        self._acting = False
        self._drive(self.agent.act(heard))
        return True
