"""Wind utilisation: the control of a charged particle swarm, corrected by the local wind [Jatmiko 2007].

    V = chi V*,  theta the angle between the intermediate velocity V* and the wind,
    WUII:    chi = (1 - cos theta) / 2: downwind 0, crosswind 1/2, upwind 1;
    WUI-45:  V* within 45 deg of downwind is forbidden: chi = 0 there and 1 elsewhere, or V* is turned to the edge of the
             forbidden cone (`wui.forbidden`).

The thesis gives the names only: (1 - cos theta) / 2 is sourced from code of others, the forbidden cone is inferred.
"""

from __future__ import annotations

from math import cos, hypot, radians, sin
from typing import Literal

from protocol.scenario import RobotScenario
from robot_agent.hand import Own
from robot_agent.interfaces import Point
from robot_agent.planning.discrete import DiscretePlanner


class WindPlanner(DiscretePlanner):
    """V of WUI-45 or WUII."""

    def __init__(self, scenario: RobotScenario, rule: Literal["forbidden", "cosine"]) -> None:
        super().__init__(scenario, scenario.wui.sampling, charged=scenario.wui.charged)
        self._rule = rule
        self._half_angle = radians(scenario.wui.angle)
        self._turns = scenario.wui.forbidden == "turn"

    def shape(self, v: Point, own: Own) -> Point:
        wind = (own.wind_x, own.wind_y)
        if self._rule == "cosine":
            chi = (1.0 - cosine(v, wind)) / 2.0
            return chi * v[0], chi * v[1]
        return avoid_downwind(v, wind, self._half_angle, self._turns)


def cosine(v: Point, wind: Point) -> float:
    """cos theta; 1, downwind, where either is 0."""
    sizes = hypot(*v) * hypot(*wind)
    return max(-1.0, min(1.0, (v[0] * wind[0] + v[1] * wind[1]) / sizes)) if sizes > 0.0 else 1.0


def avoid_downwind(v: Point, wind: Point, half_angle: float, turns: bool) -> Point:
    """v itself outside of the cone of `half_angle`, rad, about downwind; within, 0 or v turned to the nearer edge."""
    size, blow = hypot(*v), hypot(*wind)
    if size == 0.0 or blow == 0.0 or cosine(v, wind) <= cos(half_angle):
        return v
    if not turns:
        return 0.0, 0.0
    side = -half_angle if wind[0] * v[1] - wind[1] * v[0] < 0.0 else half_angle
    ux, uy = wind[0] / blow, wind[1] / blow
    return size * (ux * cos(side) - uy * sin(side)), size * (ux * sin(side) + uy * cos(side))


def wui_45(scenario: RobotScenario) -> WindPlanner:
    """WUI-45."""
    return WindPlanner(scenario, "forbidden")


def wuii(scenario: RobotScenario) -> WindPlanner:
    """WUII."""
    return WindPlanner(scenario, "cosine")
