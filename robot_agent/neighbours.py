"""What one robot has heard: the latest state of each neighbour, and relayed positions of the robots around it.

Rules: a state comes from the robot itself over a declared edge, or from a neighbour that passes it on. The consensus
laws use neighbours only; relayed positions serve to keep clear of robots that one has no edge with. What is older than
`stale_after` (relayed: `relay_age`) is not used.
"""

from __future__ import annotations

from collections.abc import Iterable

from protocol.messages import Shared
from protocol.scenario import RobotScenario

Placed = tuple[float, float, float, float]  # x, y, vx, vy of a robot, brought up to now


class Neighbours:
    """One robot's memory of the others."""

    __slots__ = ("_dt", "_latest", "_me", "_range2", "_relay", "_relay_ticks", "_relayed", "_stale_ticks", "_weights",
                 "fresh")  # fmt: skip

    def __init__(self, scenario: RobotScenario) -> None:
        control, timing = scenario.control, scenario.timing
        self._me = scenario.robot
        self._weights = dict(scenario.row)
        self._dt = timing.tick
        self._stale_ticks = max(0, round(timing.stale_after / timing.tick))
        self._relay_ticks = max(0, round(control.relay_age / timing.tick))
        self._range2 = control.relay_range**2
        self._relay = control.relay and not scenario.complete
        self._latest: dict[int, Shared] = {}
        self._relayed: dict[int, tuple[int, int, float, float, float, float]] = {}
        self.fresh: list[tuple[float, Shared]] = []  # (a_ij, state) of the neighbours that count at this tick

    def hear(self, tick: int, heard: Iterable[Shared]) -> None:
        """Take the states that arrived for tick `tick`."""
        latest = self._latest
        for state in heard:
            latest[state.robot] = state
            if self._relay:
                self._take_relayed(state)
        oldest = tick - self._stale_ticks
        self.fresh = [(a, latest[j]) for j, a in self._weights.items() if j in latest and latest[j].tick >= oldest]

    def others(self, tick: int) -> list[Placed]:
        """Everyone whose place is known, neighbours and relayed robots, moved on to `tick` at their last velocity."""
        placed: list[Placed] = []
        for _, s in self.fresh:
            age = (tick - s.tick) * self._dt
            placed.append((s.x + age * s.vx, s.y + age * s.vy, s.vx, s.vy))
        if self._relayed:
            direct = {s.robot for _, s in self.fresh}
            for j, k, x, y, vx, vy in self._relayed.values():
                if j not in direct and tick - k <= self._relay_ticks:
                    age = (tick - k) * self._dt
                    placed.append((x + age * vx, y + age * vy, vx, vy))
        return placed

    def nearby(self, tick: int, x: float, y: float) -> tuple[tuple[int, int, float, float, float, float], ...]:
        """States worth passing on: of robots within relay range of (x, y)."""
        if not self._relay:
            return ()
        oldest, range2 = tick - self._relay_ticks, self._range2
        best = {j: r for j, r in self._relayed.items() if r[1] >= oldest}
        for s in self._latest.values():
            known = best.get(s.robot)
            if s.tick >= oldest and (known is None or known[1] < s.tick):
                best[s.robot] = (s.robot, s.tick, s.x, s.y, s.vx, s.vy)
        return tuple(r for _, r in sorted(best.items()) if (r[2] - x) ** 2 + (r[3] - y) ** 2 <= range2)

    def _take_relayed(self, state: Shared) -> None:
        for record in state.nearby:
            j = record[0]
            if j != self._me:
                known = self._relayed.get(j)
                if known is None or record[1] > known[1]:
                    self._relayed[j] = record
