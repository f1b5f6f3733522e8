"""The crosswind search before the first detection.

The group sweeps along one common heading towards `search.target`. Thesis section 3.4.3: "along the direction of y axis
from the initial positions (right-up corner) to the (80 m, 50 m)". The heading is agreed, not given: every robot
proposes the one from its own place, and the proposal of the robot with the lowest number travels over the graph. When
some robot has come to the end of a leg it proposes the next one (a lawn-mower sweep upwind; the thesis does not say
what follows).
"""

from __future__ import annotations

from math import hypot

from protocol.scenario import RobotScenario
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import SEARCH, Plan, Point

MARGIN = 5.0  # legs end this far from the edge of the arena, m


class CrosswindSearch:
    """One robot's part of the common search."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._s = scenario

    def plan(self, own: Own, group: Group) -> Plan:
        """Follow the common heading; propose the next leg at the end of one."""
        if group.leg < 0:
            self._propose(own, group, 0)
        elif self._at_end(own, group):
            self._propose(own, group, group.leg + 1)
        ux, uy = group.heading
        speed = self._s.search.speed
        here = (own.x, own.y)
        velocity = (speed * ux, speed * uy)
        return Plan(SEARCH, here, p_dot=velocity, v_c=velocity, centre=here)

    def _waypoint(self, leg: int) -> Point:
        search, arena = self._s.search, self._s.arena
        if leg == 0:
            return search.target
        width = search.target[0] - (arena.x_min + MARGIN)
        legs = max(1, int(width // search.leg_spacing) + 1)
        x = search.target[0] - (leg % legs) * search.leg_spacing
        return (x, arena.y_min + MARGIN) if leg % 2 else (x, arena.y_max - MARGIN)

    def _at_end(self, own: Own, group: Group) -> bool:
        ux, uy = group.heading
        wx, wy = self._waypoint(group.leg)
        return (wx - own.x) * ux + (wy - own.y) * uy <= 0.0 and (ux, uy) != (0.0, 0.0)

    def _propose(self, own: Own, group: Group, leg: int) -> None:
        if leg > 0 and self._s.search.after == "stay":
            group.lead(leg, self._s.robot, (0.0, 0.0))
            return
        wx, wy = self._waypoint(leg)
        dx, dy = wx - own.x, wy - own.y
        length = hypot(dx, dy)
        if length > 0.0:
            group.lead(leg, self._s.robot, (dx / length, dy / length))
