"""What one robot has heard: the latest state of each neighbour, and relayed positions of the robots around it.

Rules: a state comes from the robot itself over a declared edge, or from a neighbour that passes it on. The consensus
laws use neighbours only; relayed positions serve to keep clear of robots that one has no edge with, wherever the robots
between them are. What is older than `stale_after` (relayed: `relay_age`) is not used for more than to keep clear: a robot
that fell silent stands, as far as anybody knows, where it would have come to rest (`ghosts`, for `control.remember`).
Where silent robots were is passed on, too, so that one who comes later learns of them.

A control law is given its neighbours as they are now, x_j(t - tau) + tau v_j(t - tau) for a state that is tau old
(`present`, switch `control.foresee`). Without it a formation that moves with v pulls itself back: each robot sees the others
tau v behind their places. In (5.5) of n neighbours that is beta n tau v against lambda (v_c - v), and the group moves with
v = v_c / (1 + n beta tau / lambda): half of v_c at tau = 0.1 s on a ring, a sixth at 0.5 s. A state of now is left as it is.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import hypot

from msgspec.structs import replace

from protocol.messages import Shared
from protocol.scenario import RobotScenario
from robot_agent.hand import top_acceleration
from robot_agent.row import Row

Relayed = tuple[int, int, float, float, float, float]  # robot, tick, x, y, vx, vy
Placed = tuple[float, float, float, float]  # x, y, vx, vy of a robot, brought up to now


class Neighbours:
    """One robot's memory of the others."""

    __slots__ = ("_arrived", "_brake", "_dt", "_foresee", "_latest", "_me", "_relay", "_relay_every", "_relay_ticks",
                 "_relayed", "_remember", "_row", "_stale_ticks", "_tell_of_silent", "fresh", "numbers")  # fmt: skip

    def __init__(self, scenario: RobotScenario) -> None:
        control, timing = scenario.control, scenario.timing
        self._me = scenario.robot
        self._row = Row(scenario)
        self._dt = timing.tick
        self._stale_ticks = max(0, round(timing.stale_after / timing.tick))
        self._relay_ticks = max(0, round(control.relay_age / timing.tick))
        self._relay_every = max(1, round(control.relay_period / timing.tick))
        self._relay = control.relay and not scenario.complete
        self._remember = round(control.remember / timing.tick)
        self._brake = top_acceleration(scenario.body)
        self._foresee = control.foresee
        self._tell_of_silent = control.relay and self._remember > 0
        self._arrived: dict[int, int] = {}  # when something newer of a relayed robot came last, tick
        self._latest: dict[int, Shared] = {}
        self._relayed: dict[int, Relayed] = {}
        self.fresh: list[tuple[float, Shared]] = []  # (a_ij, state) of the neighbours that count at this tick
        self.numbers: list[int] = []  # whose places `others` gave last, in its order

    def hear(self, tick: int, heard: Iterable[Shared]) -> None:
        """Take the states that arrived for tick `tick`."""
        latest = self._latest
        for state in heard:
            known = latest.get(state.robot)
            if known is None or state.tick > known.tick:  # a late state never replaces a newer one
                latest[state.robot] = state
            if state.relayed:
                self._take_relayed(tick, state)
        oldest = tick - self._stale_ticks
        self.fresh = [(a, latest[j]) for j, a in self._row.weights(tick).items() if j in latest and latest[j].tick >= oldest]

    def present(self, tick: int) -> list[tuple[float, Shared]]:
        """`fresh`, everyone moved on to `tick` at its last velocity; a state keeps the tick that it was told at."""
        if not self._foresee or all(s.tick == tick for _, s in self.fresh):
            return self.fresh
        return [(a, s if s.tick == tick else self._foreseen(tick, s)) for a, s in self.fresh]

    def _foreseen(self, tick: int, s: Shared) -> Shared:
        x, y, _, _ = self._now(tick, s.tick, s.x, s.y, s.vx, s.vy)
        return replace(s, x=x, y=y)

    def others(self, tick: int) -> list[Placed]:
        """Everyone whose place is known, neighbours and relayed robots, moved on to `tick` at their last velocity."""
        placed = [self._now(tick, s.tick, s.x, s.y, s.vx, s.vy) for _, s in self.fresh]
        self.numbers = [s.robot for _, s in self.fresh]
        relayed = self._with_former(tick) if self._row.switches else self._relayed
        if relayed:
            direct = set(self.numbers)
            for j, k, x, y, vx, vy in relayed.values():
                if j not in direct and tick - k <= self._relay_ticks:
                    placed.append(self._now(tick, k, x, y, vx, vy))
                    self.numbers.append(j)
        return placed

    def _with_former(self, tick: int) -> dict[int, Relayed]:
        """The relayed states, and those of robots that were neighbours until the graph switched: nobody has passed them
        on yet."""
        row, known = self._row.weights(tick), dict(self._relayed)
        for j, s in self._latest.items():
            if j not in row and (j not in known or known[j][1] < s.tick):
                known[j] = _record(s)
        return known

    def ghosts(self, tick: int) -> list[Placed]:
        """Where the robots that fell silent stand, to the best of one's knowledge; call it after `others`."""
        return [self._at_rest(tick, record) for record in self._silent(tick)]

    def _silent(self, tick: int) -> list[Relayed]:
        """The last states of neighbours that are stale, and of others of whom nothing new came for `relay_age`."""
        latest, relayed = self._latest, self._relayed
        missing = (latest.keys() | relayed.keys()).difference(self.numbers)
        if not missing or self._remember == 0:
            return []
        row = self._row.weights(tick)
        silent = []
        for j in sorted(missing):
            record, direct = relayed.get(j), latest.get(j)
            came = -1 if record is None else self._arrived[j]
            if direct is not None:
                came = max(came, direct.tick)
                if record is None or record[1] < direct.tick:
                    record = _record(direct)
            if record is not None and (j in row or tick - came > self._relay_ticks) and tick - record[1] <= self._remember:
                silent.append(record)
        return silent

    def _at_rest(self, tick: int, record: Relayed) -> Placed:
        """A silent robot's place, when it has braked since it was heard last."""
        _, then, x, y, vx, vy = record
        speed = hypot(vx, vy)
        if speed == 0.0:
            return x, y, 0.0, 0.0
        age = min((tick - then) * self._dt, speed / self._brake)
        way = age - 0.5 * self._brake * age * age / speed  # s at the last velocity
        return x + way * vx, y + way * vy, 0.0, 0.0

    def _now(self, tick: int, then: int, x: float, y: float, vx: float, vy: float) -> Placed:
        if then == tick:
            return x, y, vx, vy
        age = (tick - then) * self._dt
        return x + age * vx, y + age * vy, vx, vy

    def relay(self, tick: int) -> tuple[Relayed, ...]:
        """States worth passing on, once a relay period: all that are not too old, and the last ones of silent robots."""
        if tick % self._relay_every:
            return ()
        silent = self._silent(tick) if self._tell_of_silent else []
        if not self._relay:
            return tuple(silent)
        oldest = tick - self._relay_ticks
        known = {j: r for j, r in self._relayed.items() if r[1] >= oldest}
        for s in self._latest.values():
            if s.tick >= oldest and (s.robot not in known or known[s.robot][1] < s.tick):
                known[s.robot] = _record(s)
        return (*known.values(), *(record for record in silent if record[0] not in known))

    def _take_relayed(self, tick: int, state: Shared) -> None:
        relayed = self._relayed
        for record in state.relayed:
            j = record[0]
            if j != self._me and (j not in relayed or record[1] > relayed[j][1]):
                relayed[j] = record
                # Only places of silent robots are passed on when they are old.
                self._arrived[j] = tick if tick - record[1] <= self._relay_ticks else record[1]


def _record(s: Shared) -> Relayed:
    return s.robot, s.tick, s.x, s.y, s.vx, s.vy
