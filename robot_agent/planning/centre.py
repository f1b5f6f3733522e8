"""The plan of Figure 2.2: the decided position itself, p_i(k) = h^ic(k), held from one decision to the next."""

from __future__ import annotations

from protocol.scenario import RobotScenario
from robot_agent.hand import Own
from robot_agent.interfaces import LOST, TRACE, Plan, Planner, Point
from robot_agent.planning.trace import scaled


class CentrePlanner(Planner):
    """Goes where the decision says."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._speed = scenario.planning.speed

    def plan(self, own: Own, h: Point, lost: bool) -> Plan:
        v_c = scaled(h[0] - own.x, h[1] - own.y, self._speed)
        return Plan(LOST if lost else TRACE, h, v_c=v_c, centre=h)
