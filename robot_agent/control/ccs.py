"""A reading of the cooperative control system CCS(L=2) as a control law.

[Lu & Han 2011, "Decision-making in a multi-robot system for odor source localization"] could not be read, and the thesis
does not say what L is. INFERRED: L is the number of nearest neighbours that a robot's law takes; the law is (2.7), with
places in a formation about the planned position: a robot tracks p_i + r (cos 2 pi i / N, sin 2 pi i / N) and lets its
tracking error agree with those of its L nearest neighbours on the graph.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import cos, pi, sin

from protocol.scenario import RobotScenario
from robot_agent.control.consensus import ConsensusControl
from robot_agent.hand import Own
from robot_agent.interfaces import SEARCH, Fresh, Plan, Point
from robot_agent.neighbours import Placed


class CcsControl(ConsensusControl):
    """(2.7) in a formation with the L nearest neighbours."""

    def __init__(self, scenario: RobotScenario) -> None:
        super().__init__(scenario)
        self._nearest = scenario.ccs.neighbours
        angle = 2.0 * pi * scenario.robot / scenario.robots
        self._place = (scenario.ccs.radius * cos(angle), scenario.ccs.radius * sin(angle))

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        if plan.mode != SEARCH:
            plan = replace(plan, target=(plan.target[0] + self._place[0], plan.target[1] + self._place[1]))
        return super().control(own, nearest(own, fresh, self._nearest), others, plan, dt)


def nearest(own: Own, fresh: Fresh, most: int) -> Fresh:
    """The `most` neighbours nearest to this robot; of two as near as each other the lower number."""
    return sorted(fresh, key=lambda pair: ((pair[1].x - own.x) ** 2 + (pair[1].y - own.y) ** 2, pair[1].robot))[:most]
