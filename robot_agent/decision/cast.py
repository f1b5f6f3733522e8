"""Surge-cast in formation: upwind while the group smells the odour, crosswind legs that grow when it has lost it.

A baseline: nothing is decided about the source. After the moth-like strategy of single robots (surge on a detection, cast
on loss). The group is one searcher here: the latest detection, its time and place, travels over the graph, so that all
robots surge and cast together; the legs are a function of the time since then, so that nothing else has to be agreed.
Before the first detection in the group the common crosswind search is the same as for every other algorithm.

    lost when nobody detected on the last `surge.lost` m of way. Then the middle of the group goes
    from the place of the latest detection +1, -2, +3, ... times `surge.cast` across the wind, each
    leg `surge.retreat` m further downwind: what is lost for long lies to the side or behind.
"""

from __future__ import annotations

from collections.abc import Iterable

from protocol.messages import NEVER
from protocol.scenario import RobotScenario
from robot_agent.decision.surge import AHEAD, NoDecision, inside, middle_of
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import Around, Fresh, Point

Met = tuple[float, float, float]  # time of a detection, s, and its place, m


class CastDecision(NoDecision):
    """Upwind while it smells, across when it does not."""

    def __init__(self, scenario: RobotScenario) -> None:
        super().__init__(scenario)
        self._p = scenario.surge
        self._latest: Met = (NEVER, 0.0, 0.0)

    def detect(self, own: Own) -> None:
        self._take([(own.t, own.x, own.y)])

    def decide(self, own: Own, group: Group, detected: bool, around: Around) -> None:
        self.advance(around.fresh, 0.0)
        wind = self._feel_wind(own)
        self._stand(own)
        met_at, x, y = self._latest
        way = (own.t - met_at) * self._p.speed - self._p.lost if met_at >= 0.0 else 0.0
        if way <= 0.0:
            self.h = (own.x - AHEAD * wind[0], own.y - AHEAD * wind[1])
            return
        across, down = cast(way, self._p.cast, self._p.retreat)
        goal = (x + down * wind[0] - across * wind[1], y + down * wind[1] + across * wind[0])
        goal_x, goal_y = inside(goal, self._s, self._p.margin)
        middle_x, middle_y = middle_of(own, around)
        self.h = (own.x + goal_x - middle_x, own.y + goal_y - middle_y)

    def advance(self, fresh: Fresh, dt: float) -> None:
        self._take((s.notes[0], s.notes[1], s.notes[2]) for _, s in fresh if len(s.notes) == 3)

    def notes(self, own: Own) -> tuple[float, ...]:
        return self._latest

    def _take(self, met: Iterable[Met]) -> None:
        self._latest = max((self._latest, *met))  # ties are broken by place: all robots agree


def cast(way: float, reach: float, retreat: float) -> Point:
    """Where the casting searcher is after `way` m: (across the wind, downwind), m from where it began.

    Leg n goes from (-1)^n (n-1) reach to -(-1)^n n reach and is (2n-1) reach long; n legs are n^2 reach long.
    """
    n = 1
    while way > n * n * reach:
        n += 1
    on_leg = way - (n - 1) ** 2 * reach
    side = 1.0 if n % 2 else -1.0
    return side * (on_leg - (n - 1) * reach), (n - 1) * retreat
