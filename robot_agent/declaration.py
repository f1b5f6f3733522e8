"""The swarm says that it has found the source, and where, without being told: agreed over the graph, with no centre.

Rules, for robot i at every decision; not of the thesis:
1. Vote. Every robot tells where it holds the source to be, and the radius of its posterior there. A vote is named by its
   robot and that robot's time; the newest of each robot is passed on from neighbour to neighbour.
2. Declare. i declares when its posterior has been narrower than `radius` for `hold` seconds while its estimate stayed within
   `tolerance`, the odour was met again there in that time, `meetings` times in the latest `recall` seconds, and the newest
   vote of every robot that it heard of within `window` is as narrow and within `tolerance` too. (A plume that leaves where
   a group turns looks like one that begins there: robot_agent/plume/evidence.py.)
   A robot that is dead, or beyond a broken link, is not heard of and holds nobody up; one that joined late has not seen what
   the others saw: it votes once it is sure itself, and holds nobody up before.
3. Adopt. A declaration (when, by whom, where) is passed on. Of two the earlier one wins, then the one by the lower number,
   so that all robots that hear of each other tell the same place; what is heard twice, late or in another order changes
   nothing. On a graph that is connected over time, directed or not, that takes as many exchanges as it is wide.
The age of a vote is counted from when it was first heard: clocks that differ between robots do no harm. A robot that stood
still (it hung, or was too late) for longer than `window` has nobody's vote any more: it has to be sure for `hold` anew.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from math import dist, inf
from typing import NamedTuple

from protocol.messages import DeclaredRecord, Shared, VoteRecord
from protocol.scenario import RobotScenario
from robot_agent.interfaces import OFTEN, Point

UNSURE = -1.0  # radius in the vote of a robot that has no posterior


class Vote(NamedTuple):
    """Where a robot holds the source to be."""

    t: float  # by its own clock, s
    x: float  # m
    y: float
    radius: float  # of its posterior, m; UNSURE: it has none
    heard_at: float  # by my clock, s


class Declaration:
    """One robot's part in it."""

    __slots__ = ("_anchor", "_arena", "_judged_at", "_me", "_on", "_p", "_robots", "_since", "_ticks_per_telling",
                 "_told_in", "_votes", "made")  # fmt: skip

    def __init__(self, scenario: RobotScenario) -> None:
        self._p = scenario.declaration
        self._on = scenario.declaration.stop == "declared"
        self._arena = scenario.arena
        self._me = scenario.robot
        self._robots = scenario.robots
        self._ticks_per_telling = max(1, round(self._p.period / scenario.timing.tick))
        self._votes: dict[int, Vote] = {}
        self._since = inf  # when my posterior became narrow and my estimate came to rest, s
        self._anchor: Point = (0.0, 0.0)  # and where that was
        self._judged_at = -inf  # s
        self._told_in = -1  # number of the period in which the votes were told last
        self.made: DeclaredRecord | None = None  # to be told

    def hear(self, t: float, heard: Iterable[Shared]) -> None:
        """Take the votes and declarations that neighbours tell at time `t`, s."""
        if not self._on:
            return
        for state in heard:
            for robot, when, x, y, radius in state.votes:
                known = self._votes.get(robot)
                if robot != self._me and 0 <= robot < self._robots and (known is None or when > known.t):
                    self._votes[robot] = Vote(when, x, y, radius, t)
            if state.declared is not None:
                self._adopt(state.declared)

    def judge(
        self,
        t: float,
        estimate: Point,
        radius: float | None,
        late: bool = False,
        meetings: Callable[[float, Point], int] = lambda since, place: OFTEN,
    ) -> None:
        """At every decision: vote, and declare when all agree.

        Args:
            estimate: where this robot holds the source to be, m.
            radius: of its posterior there, m; None: it has none.
            late: this robot joined a swarm that was on its way.
            meetings: tells how often the odour was met again since then, s, as a source at a place, m, explains it; asked
                when it matters.
        """
        if not self._on:
            return
        p, (x, y) = self._p, estimate
        if late and (radius is None or radius > p.radius):
            self._votes.pop(self._me, None)
            self._since, self._judged_at = inf, t
            return
        self._votes[self._me] = Vote(t, x, y, UNSURE if radius is None else radius, t)
        paused = t - self._judged_at > p.window
        self._judged_at = t
        if radius is None or radius > p.radius:
            self._since = inf
        elif paused or self._since == inf or dist(estimate, self._anchor) > p.tolerance:
            self._since, self._anchor = t, estimate
        if t - self._since >= p.hold and all(self._agrees(vote, estimate) for vote in self._asked(t).values()):
            of_late = min(1, p.meetings)
            if meetings(t - p.recall, estimate) >= p.meetings and meetings(self._since, estimate) >= of_late:
                self._adopt((t, self._me, x, y))

    def votes(self, tick: int, t: float) -> tuple[VoteRecord, ...]:
        """The votes to tell at this tick: the newest of every robot that was heard of lately, mine among them.

        They are told once in `period`: at its first tick, or the first one after ticks that were missed.
        """
        period = tick // self._ticks_per_telling
        if period == self._told_in:
            return ()
        self._told_in = period
        return tuple((robot, v.t, v.x, v.y, v.radius) for robot, v in sorted(self._asked(t).items()))

    def _asked(self, t: float) -> dict[int, Vote]:
        return {robot: vote for robot, vote in self._votes.items() if t - vote.heard_at <= self._p.window}

    def _agrees(self, vote: Vote, estimate: Point) -> bool:
        near = dist((vote.x, vote.y), estimate) <= self._p.tolerance
        return near and 0.0 <= vote.radius <= self._p.radius

    def _adopt(self, record: DeclaredRecord) -> None:
        t, robot, x, y = record
        arena = self._arena
        inside = arena.x_min <= x <= arena.x_max and arena.y_min <= y <= arena.y_max
        if inside and t >= 0.0 and 0 <= robot < self._robots and (self.made is None or record < self.made):
            self.made = record
