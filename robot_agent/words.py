"""What the robots around one measured, each in its own name: input of the resilient fusion (`fusion.judge` = "words").

The filter of robot_agent.resilient takes for a lie whatever one robot alone has, and a lone measurement is just that. So
each robot also tells its word: its own estimate x_hat_j, made of its own measurements only, and when it measured last.
u_i is then, on each axis, the median of 2F+1 votes, F = `fusion.liars`:

    the latest words among the robot's own and its neighbours', not older than `fusion.hold`; where there are fewer, the
    missing votes are its own word, or y_i when it has none.

With at most F liars among its neighbours every median lies between two honest votes: u_i is in the hull of the honest
words and y_i, and where 2F+1 robots in the neighbourhood have words, of the honest words alone, wherever y_i was before.
One case is left out of that: a robot without a word that hears no more than F of them cannot tell a lone find from a lone
lie. `fusion.lone` = "wait" has it wait for more, which keeps the promise; "follow", the default, has it follow the latest
for as long as that lasts, because most finds are lone at first. The latest count, not all: robots that have come nearer
to the source measure better.

Rules: pure; words come with the states of neighbours that count now, and nobody passes on another's word. A word of the
future, or from outside of the arena, where (3.9) with the gate "area" puts nothing, no honest robot has: it is no vote. A
word has no variance, so that nobody gains weight by claiming a small one; claiming to be the latest gains one vote of 2F+1.
All of it is ours; for the median see LeBlanc et al. 2013, named in robot_agent.resilient, whose W-MSR the states y_j go
through as before.
"""

from __future__ import annotations

from collections.abc import Iterable
from statistics import median

from protocol.scenario import RobotScenario
from robot_agent.interfaces import Fresh, Point

Word = tuple[float, float, float]  # x, y, m, and when its robot measured last, s


class Words:
    """One robot's judgement of words."""

    __slots__ = ("_arena", "_hold", "_liars", "_lone", "_margin", "_skew")

    def __init__(self, scenario: RobotScenario) -> None:
        fusion, trust = scenario.fusion, scenario.trust
        self._arena = scenario.arena
        self._hold, self._liars, self._lone = fusion.hold, fusion.liars, fusion.lone
        self._skew = trust.skew
        # The other gates let a source be as far outside as the states that are believed.
        self._margin = trust.slack if scenario.decision.gate == "area" else trust.decided_margin

    def input(self, t: float, own: Word | None, fresh: Fresh, y: Point) -> Point | None:
        """u_i, m; None: nothing to go by.

        Args:
            t: own time, s.
            own: own word; None: this robot has not measured yet.
            fresh: the neighbours that count now.
            y: own fusion state y_i, m.
        """
        if own is not None and own[2] < t - self._hold:
            own = None
        heard = [s.word for _, s in fresh if s.word is not None and self._counts(t, s.word)]
        return judge(own, heard, y, self._liars, follow=self._lone == "follow")

    def _counts(self, t: float, word: Word) -> bool:
        x, y, at = word
        arena, m = self._arena, self._margin
        inside = arena.x_min - m <= x <= arena.x_max + m and arena.y_min - m <= y <= arena.y_max + m
        return inside and t - self._hold <= at <= t + self._skew


def judge(own: Word | None, heard: Iterable[Word], y: Point, liars: int, *, follow: bool) -> Point | None:
    """The median of 2 `liars` + 1 votes; None: there is no word, or too few and it does not `follow`."""
    words = sorted(heard if own is None else [own, *heard], key=_latest_first)
    if own is None and len(words) <= liars:
        return words[0][:2] if words and follow else None
    latest = words[: 2 * liars + 1]
    rest = 2 * liars + 1 - len(latest)
    filler = y if own is None else own
    xs = [w[0] for w in latest] + rest * [filler[0]]
    ys = [w[1] for w in latest] + rest * [filler[1]]
    return median(xs), median(ys)


def _latest_first(word: Word) -> tuple[float, float, float]:
    x, y, at = word
    return -at, x, y
