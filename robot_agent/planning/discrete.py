"""The direct discrete control of particle swarms: a velocity that is held over a sampling time.

Thesis (2.1), (2.2), (2.5); "the real control signal as an input to the mobile robot is v_i(k+1)" (section 2.2).
x_i(k+1) = x_i(k) + v_i(k+1) makes v_i(k+1) a way per step; driven at v_i(k+1) / dt for the sampling time dt, and no longer
than v_max dt. It is the velocity that is held, not the place x_i(k+1) that is sought: it is what the thesis calls the
input, and a robot that was pushed aside does not come back for a place that had no meaning but as the end of a step.
Ways end at the edge of the arena, and near it the velocity outwards is one from which the robot can stop.
"""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

from protocol.scenario import RobotScenario
from protocol.scenario.sections import Arena
from robot_agent import particle
from robot_agent.hand import Own, top_acceleration
from robot_agent.interfaces import LOST, TRACE, Plan, Planner, Point
from robot_agent.particle import Sampling


class DiscretePlanner(Planner):
    """Holds v_i(k+1) from one k to the next."""

    def __init__(self, scenario: RobotScenario, period: float, charged: bool = False) -> None:
        self._s = scenario
        self._swarm: particle.Swarm = scenario.cpso if charged else scenario.pso
        self._period = period
        self._sampling = Sampling(period, scenario.timing.decision)  # the same instants as the decision's
        self._v: Point | None = None  # v_i(k), m per step
        self._end: Point = (0.0, 0.0)  # x_i(k+1), m
        self._brake = 0.5 * top_acceleration(scenario.body)

    def plan(self, own: Own, h: Point, lost: bool) -> Plan:
        if self._sampling.due(own.t):
            x = (own.x, own.y)
            alpha = particle.coefficients(self._s.seed, self._s.robot, own.tick, self._swarm)
            v_0 = (own.vx * self._period, own.vy * self._period)  # of a robot that was on its way, not at rest
            longest = self._s.planning.speed * self._period
            v = self.shape(particle.next_velocity(self._v or v_0, x, h, alpha, self._swarm.inertia, longest), own)
            self._end = particle.within((x[0] + v[0], x[1] + v[1]), self._s.arena)
            self._v = (self._end[0] - x[0], self._end[1] - x[1])
        plan = Plan(LOST if lost else TRACE, self._end, centre=h)
        return self.follow(own, plan)

    def follow(self, own: Own, plan: Plan) -> Plan:
        v_x, v_y = self._v or (0.0, 0.0)
        v_c = inside((v_x / self._period, v_y / self._period), own, self._s.arena, self._brake)
        return replace(plan, p_dot=v_c, v_c=v_c)

    def shape(self, v: Point, own: Own) -> Point:
        """What becomes of v_i(k+1), m per step, before it is driven."""
        return v


def pso(scenario: RobotScenario) -> DiscretePlanner:
    """The control of (2.1)-(2.3)."""
    return DiscretePlanner(scenario, scenario.pso.sampling)


def cpso(scenario: RobotScenario) -> DiscretePlanner:
    """With the constants of the charged swarm."""
    return DiscretePlanner(scenario, scenario.pso.sampling, charged=True)


def inside(v: Point, own: Own, arena: Arena, brake: float) -> Point:
    """v, m/s, with what leads out of the arena limited to what `brake`, m/s^2, can stop before the edge."""

    def limited(v_1: float, x: float, low: float, high: float) -> float:
        slowest, fastest = -sqrt(2.0 * brake * max(0.0, x - low)), sqrt(2.0 * brake * max(0.0, high - x))
        return max(slowest, min(fastest, v_1))

    return limited(v[0], own.x, arena.x_min, arena.x_max), limited(v[1], own.y, arena.y_min, arena.y_max)
