"""What one robot has heard: the latest state of each neighbour, and relayed positions of the robots around it.

Rules: a state comes from the robot itself over a declared edge, or from a neighbour that passes it on. The consensus
laws use neighbours only; relayed positions serve to keep clear of robots that one has no edge with, wherever the robots
between them are. What is older than `stale_after` (relayed: `relay_age`) is not used.
"""

from __future__ import annotations

from collections.abc import Iterable

from protocol.messages import Shared
from protocol.scenario import RobotScenario

Relayed = tuple[int, int, float, float, float, float]  # robot, tick, x, y, vx, vy
Placed = tuple[float, float, float, float]  # x, y, vx, vy of a robot, brought up to now


class Neighbours:
    """One robot's memory of the others."""

    __slots__ = ("_dt", "_latest", "_me", "_relay", "_relay_every", "_relay_ticks", "_relayed", "_stale_ticks",
                 "_weights", "fresh", "numbers")  # fmt: skip

    def __init__(self, scenario: RobotScenario) -> None:
        control, timing = scenario.control, scenario.timing
        self._me = scenario.robot
        self._weights = dict(scenario.row)
        self._dt = timing.tick
        self._stale_ticks = max(0, round(timing.stale_after / timing.tick))
        self._relay_ticks = max(0, round(control.relay_age / timing.tick))
        self._relay_every = max(1, round(control.relay_period / timing.tick))
        self._relay = control.relay and not scenario.complete
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
                self._take_relayed(state)
        oldest = tick - self._stale_ticks
        self.fresh = [(a, latest[j]) for j, a in self._weights.items() if j in latest and latest[j].tick >= oldest]

    def others(self, tick: int) -> list[Placed]:
        """Everyone whose place is known, neighbours and relayed robots, moved on to `tick` at their last velocity."""
        placed = [self._now(tick, s.tick, s.x, s.y, s.vx, s.vy) for _, s in self.fresh]
        self.numbers = [s.robot for _, s in self.fresh]
        if self._relayed:
            direct = set(self.numbers)
            for j, k, x, y, vx, vy in self._relayed.values():
                if j not in direct and tick - k <= self._relay_ticks:
                    placed.append(self._now(tick, k, x, y, vx, vy))
                    self.numbers.append(j)
        return placed

    def _now(self, tick: int, then: int, x: float, y: float, vx: float, vy: float) -> Placed:
        if then == tick:
            return x, y, vx, vy
        age = (tick - then) * self._dt
        return x + age * vx, y + age * vy, vx, vy

    def relay(self, tick: int) -> tuple[Relayed, ...]:
        """States worth passing on, once a relay period: all that are not too old."""
        if not self._relay or tick % self._relay_every:
            return ()
        oldest = tick - self._relay_ticks
        known = {j: r for j, r in self._relayed.items() if r[1] >= oldest}
        for s in self._latest.values():
            if s.tick >= oldest and (s.robot not in known or known[s.robot][1] < s.tick):
                known[s.robot] = (s.robot, s.tick, s.x, s.y, s.vx, s.vy)
        return tuple(known.values())

    def _take_relayed(self, state: Shared) -> None:
        relayed = self._relayed
        for record in state.relayed:
            j = record[0]
            if j != self._me and (j not in relayed or record[1] > relayed[j][1]):
                relayed[j] = record
