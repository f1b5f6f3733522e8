"""One robot's lock-step: reading in, shared state out, neighbours' states in, drive out.

Rules: no clock, no socket; messages go in by `take_*` and out by the two publications given at the start. A reading
says which (neighbour, tick) states to wait for; the session waits for exactly these, and a neighbour that is lost is
not waited for. What is late, early, double or not asked for is counted and dropped; nothing raises. A reading that comes
twice says that somebody misses something: what was said is said again, and whoever has it drops it.
"""

from __future__ import annotations

from collections.abc import Callable

from protocol.messages import Drive, Reading, Shared
from protocol.scenario.faults import HISTORY  # ticks that a state is kept, for readings that ask for an older one
from robot_agent.agent import Agent
from robot_agent.faults import false_sense

# At these repetitions of a reading older states are told, too, and not each time: a neighbour that hangs takes nothing, and
# a socket has room for some 200 of them.
ALL_OF_THEM = (1, 10)


class RobotSession:
    """Drives an `Agent` through the ticks of a run."""

    def __init__(self, agent: Agent, tell: Callable[[Shared], None], drive: Callable[[Drive], None]) -> None:
        self.agent = agent
        self.tick = -1
        self.dropped = 0
        self._sense = false_sense(agent)
        self._tell = tell
        self._drive = drive
        self._states: dict[int, dict[int, Shared]] = {}  # tick -> neighbour -> its state
        self._said: dict[int, Shared] = {}  # tick -> what was told then, for as long as somebody may wait for it
        self._repeated = 0  # how often this tick's reading came again
        self._hears: tuple[tuple[int, int], ...] = ()
        self._missing: set[tuple[int, int]] = set()
        self._gone: set[int] = set()  # neighbours that no link leads to now
        self.waiting = False  # for states of neighbours
        self._answer: Drive | None = None  # of this tick

    def take_reading(self, reading: Reading) -> bool:
        """Begin the next tick; whether the tick was finished at once."""
        tick = reading.tick
        if tick != self.tick + 1 or reading.robot != self.agent.robot or self.waiting:
            if tick == self.tick and reading.robot == self.agent.robot:
                self._say_again()
            else:
                self.dropped += 1
            return False
        self.tick = tick
        states = self._states
        states.pop(tick - HISTORY, None)
        said = self._said
        said.pop(tick - HISTORY, None)
        self._repeated = 0
        state = said[tick] = self._sense(reading)
        self._tell(state)
        self._hears = hears = reading.hears
        of_now = states.get(tick)
        if of_now is None:
            of_now = states[tick] = {}
        self._missing = {h for h in hears if h[0] not in (of_now if h[1] == tick else states.get(h[1], ()))}
        if self._gone:
            self._missing = {h for h in self._missing if h[0] not in self._gone}
        self.waiting = True
        self._answer = None
        return False if self._missing else self._finish()

    def take_shared(self, state: Shared) -> bool:
        """Take a neighbour's state; whether that finished the tick."""
        tick, robot = state.tick, state.robot
        # A neighbour can be one tick ahead: the world may have sent it the next reading first.
        if not self.tick - HISTORY < tick <= self.tick + 1:
            self.dropped += 1
            return False
        of_tick = self._states.get(tick)
        if of_tick is None:
            of_tick = self._states[tick] = {}
        elif robot in of_tick:
            self.dropped += 1
            return False
        of_tick[robot] = state
        if self.waiting:
            self._missing.discard((robot, tick))
            return False if self._missing else self._finish()
        return False

    def lose(self, robot: int) -> bool:
        """A neighbour is gone: do not wait for it until it is seen; whether that finished the tick."""
        self._gone.add(robot)
        if not self.waiting:
            return False
        self._missing = {h for h in self._missing if h[0] != robot}
        return False if self._missing else self._finish()

    def see(self, robot: int) -> None:
        """A neighbour is linked (again)."""
        self._gone.discard(robot)

    def resume(self, tick: int) -> None:
        """The next reading is that of `tick`: the world went on without this robot. What it knew it keeps; a tick that
        was not finished is left as it is."""
        if tick > self.tick:
            self.tick = tick - 1
            self.waiting = False
            self._missing = set()
            self._states = {k: states for k, states in self._states.items() if k > tick - HISTORY}
            self._said = {k: state for k, state in self._said.items() if k > tick - HISTORY}

    def _say_again(self) -> None:
        """A world that came back, or waits in vain, wants to hear this tick again; links may have come and gone."""
        self._repeated += 1
        for tick, state in self._said.items():
            if tick == self.tick or self._repeated in ALL_OF_THEM:
                self._tell(state)
        if self._answer is not None:
            self._drive(self._answer)

    def _finish(self) -> bool:
        states = self._states
        heard = [states[k][j] for j, k in self._hears if k in states and j in states[k]]
        self.waiting = False
        self._answer = self.agent.act(heard)
        self._drive(self._answer)
        return True
