"""A robot that joins a swarm that is already on its way: what it lost, it takes back from its neighbours.

A robot whose first reading is not that of tick 0 was started late, or again after a crash. It stands still and decides
nothing until it has heard a neighbour (at most `timing.listen`, then it begins by itself). From what it hears:
    detections, best place, leg and heading of the search: the group's maxima, by `Group.merge`, as at every tick;
    fusion state y_i and decision h^ic: on each axis the median over the neighbours that have begun, so that one of three
        that lies decides nothing; its own place, as at a first detection, when nobody else has begun;
    a controller's virtual robot: begins at the real one, as in Algorithm 5;
    places of robots that fell silent: neighbours pass them on (robot_agent.neighbours).
What neighbours cannot give, its own wind memory, fills again with time: see `WindMemory.reaches`.
"""

from __future__ import annotations

from collections.abc import Iterable
from statistics import median

from protocol.messages import Shared
from protocol.scenario import RobotScenario
from robot_agent.hand import Own
from robot_agent.interfaces import SEARCH, Fresh, Plan, Point


class Rejoin:
    """Whether and when one robot has taken back what it lost."""

    def __init__(self, scenario: RobotScenario) -> None:
        self.joined_at: int | None = None  # its first tick, when it came late
        self.done_at: int | None = None  # tick at which it had taken back what it lost
        self._patience = round(scenario.timing.listen / scenario.timing.tick)

    @property
    def listening(self) -> bool:
        """Whether it still waits for neighbours."""
        return self.joined_at is not None and self.done_at is None

    def sense(self, own: Own) -> None:
        """The first reading has come."""
        if own.tick > 0:
            self.joined_at = own.tick

    def hear(self, own: Own, fresh: Fresh) -> bool:
        """Whether this is the tick at which there is nothing more to wait for."""
        if self.joined_at is None or not self.listening:
            return False
        if not fresh and own.tick - self.joined_at < self._patience:
            return False
        self.done_at = own.tick
        return True


def at_rest(own: Own) -> Plan:
    """The plan of a robot that stands and waits."""
    return Plan(SEARCH, (own.x, own.y), centre=(own.x, own.y))


def begun(fresh: Fresh) -> list[Shared]:
    """The neighbours whose fusion state and decision mean something."""
    return [state for _, state in fresh if state.first_detected_at >= 0.0]


def middle(points: Iterable[Point]) -> Point:
    """The median on each axis, m."""
    xs, ys = zip(*points, strict=True)
    return median(xs), median(ys)
