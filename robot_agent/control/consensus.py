"""The consensus law of chapter 2 towards the robots' own targets.

Thesis (2.6) x_i' = u_i, (2.7):  u_i = -alpha_i (x_i - p_i) - sum_j a_ij [(x_i - p_i) - (x_j - p_j)], Table 2.1.

The law gives a velocity. Limited to v_max, it is what the hand, a double integrator (1.7), follows with the gain
`consensus.gain`. p_j comes from the neighbour itself (`Shared.virtual`); one that has no target yet is left out.
(3.35) is added when somebody is within `consensus.clearance`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from msgspec.structs import replace

from protocol.scenario import RobotScenario
from robot_agent.control.repulsion import keep_clear
from robot_agent.hand import Own, top_acceleration
from robot_agent.interfaces import SEARCH, Controller, Fresh, Plan, Point
from robot_agent.neighbours import Placed
from robot_agent.particle import shortened


class ConsensusControl(Controller):
    """(2.7) for the hand; tells its neighbours p_i."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._p = scenario.consensus
        self._potential = replace(scenario.repulsion, d=scenario.consensus.clearance)
        self._top = top_acceleration(scenario.body)
        self._target: Point | None = None

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        p = self._p
        if plan.mode == SEARCH:  # the search gives a velocity, not a place
            self._target = None
            v = plan.v_c
        else:
            p_x, p_y = self._target = plan.target
            offsets = ((a_ij, (s.x - s.virtual[0], s.y - s.virtual[1])) for a_ij, s in fresh if len(s.virtual) == 2)
            v = consensus((own.x - p_x, own.y - p_y), offsets, p.alpha)
        v = shortened(v, p.max_speed)
        u = (p.gain * (v[0] - own.vx), p.gain * (v[1] - own.vy))
        return keep_clear(u, own, others, self._potential, self._top)

    def virtual(self) -> tuple[float, ...]:
        return self._target or ()


def consensus(offset: Point, offsets: Iterable[tuple[float, Point]], alpha: float) -> Point:
    """u_i of (2.7), m/s.

    Args:
        offset: x_i - p_i, m.
        offsets: (a_ij, x_j - p_j) of the neighbours.
        alpha: alpha_i, 1/s.
    """
    x, y = offset
    u_x, u_y = -alpha * x, -alpha * y
    for a_ij, (x_j, y_j) in offsets:
        u_x -= a_ij * (x - x_j)
        u_y -= a_ij * (y - y_j)
    return u_x, u_y
