"""Beliefs of many robots as one row per decision, although they arrive in any order across the robots.

Rules: pure; rows come out in the order of time and never change afterwards. A row waits for the robots that
may still speak, but no longer than `PATIENCE` decisions: a robot that is dead, hung or never started holds
nobody up. What a robot said last stays valid for `VALID` decisions, so that one lost message makes no gap.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from protocol.messages import Belief, BeliefMap

PATIENCE = 10  # decisions
VALID = 3  # decisions
_SLACK = 1e-6  # s


Told = TypeVar("Told", Belief, BeliefMap)


@dataclass(frozen=True, slots=True)
class Row(Generic[Told]):
    """What the robots think at one decision."""

    tick: int
    t: float
    beliefs: dict[int, Told]  # by robot, in the order of the robots; at most VALID decisions old


Decision = Row[Belief]


@dataclass(slots=True)
class Board(Generic[Told]):
    """Collects the beliefs of robots 0..n-1 that decide every `period` simulated seconds."""

    n: int
    period: float
    late: int = 0  # beliefs that came after their row had gone
    _pending: dict[int, dict[int, Told]] = field(default_factory=dict)
    _newest: dict[int, Told] = field(default_factory=dict)  # of each robot, arrived
    _shown: dict[int, Told] = field(default_factory=dict)  # of each robot, in rows that have gone
    _gone: int = -1  # tick of the last row that has gone
    _begun: float | None = None

    def add(self, beliefs: Iterable[Told]) -> None:
        """Take beliefs that arrived."""
        for belief in beliefs:
            i = belief.robot
            if not 0 <= i < self.n:
                continue
            if self._begun is None:
                self._begun = belief.t
            if i not in self._newest or belief.tick >= self._newest[i].tick:
                self._newest[i] = belief
            if belief.tick <= self._gone:
                self.late += 1
            else:
                self._pending.setdefault(belief.tick, {})[i] = belief

    def rows(self, live: Iterable[int], *, all_of_them: bool = False) -> list[Row[Told]]:
        """Rows that are complete, or have waited long enough.

        Args:
            live: robots that are alive, as far as known.
            all_of_them: do not wait for anybody.
        """
        live = tuple(live)
        rows: list[Row[Told]] = []
        latest = max((belief.t for belief in self._newest.values()), default=0.0)
        for tick in sorted(self._pending):
            if not all_of_them and any(self._awaited(i, tick, latest) for i in live):
                break
            rows.append(self._row(tick, self._pending.pop(tick)))
        return rows

    def _awaited(self, i: int, tick: int, latest: float) -> bool:
        newest = self._newest.get(i)
        if newest is not None and newest.tick >= tick:
            return False
        spoke = self._begun if newest is None else newest.t
        return spoke is not None and latest - spoke <= PATIENCE * self.period + _SLACK

    def _row(self, tick: int, spoken: dict[int, Told]) -> Row[Told]:
        self._gone = tick
        self._shown.update(spoken)
        t = next(iter(spoken.values())).t
        valid = {i: b for i, b in self._shown.items() if t - b.t <= VALID * self.period + _SLACK}
        return Row(tick, t, dict(sorted(valid.items())))
