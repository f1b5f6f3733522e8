"""The plan of `plume-map`: the group as a line across the wind that goes to the estimate and back and forth over it.

Every robot plans for the whole line and takes its own place in it. With c the middle of the group, m and S the mean and the
covariance of the posterior, w the direction of the wind, n across it, s_w and s_n the deviations along them:
    goal      m; within A + 2 m of it  m -+ A w,  A = 1.5 s_w within [1.5, 8] m, the other way when it is reached;
              when nobody has smelt anything for `lost_after` also  +- 1.5 s_n n, changing sides every second leg;
              when s_w < 2 m, +- `sway` n instead: the sides of the plume are passed, too, not only its beginning;
              while somebody smells and s_w > 2 m always upwind
    way       c moves to the goal at `speed`, slower on the last 1.5 m
    line      robot i at c + (rank_i - (N - 1) / 2) d n,  d = 2 s_n / (N - 1) within [2, 6] m; rank_i: its place across the
              wind among those that it knows of, so that ways do not cross. While somebody smells the line grows no wider,
            and under way nobody is faster than `settle` towards the own place: what a robot does sideways it lacks upwind.
A line that is 2 m apart leaves no place further than 1 m from a robot that passes.
"""

from __future__ import annotations

from math import hypot

from protocol.scenario import RobotScenario
from robot_agent.decision.plume_map import PlumeMapDecision, deviation_along
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import LOST, TRACE, Around, Decision, Plan, Planner, Point

NEAR = 2.0  # m beyond A: the group has come to its estimate
THERE = 1.0  # m: a goal is reached
SLOW = 1.5  # m: how far before its goal the group slows down
SHARP = 2.0  # m: s_w from which on the group may turn back downwind although it smells something
SPREAD = 1.5  # deviations that a leg covers
AHEAD = 1.5  # s: a place moves on with the group for so long when no decision follows


class BracketPlanner(Planner):
    """One robot's plan for the line, and its place in it."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._p, self._arena, self._me = scenario.plume_map, scenario.arena, scenario.robot
        self._upwind = True
        self._side = 1.0
        self._leg_since = 0.0
        self._planned_at = 0.0
        self._next: Plan | None = None

    def brief(self, own: Own, decision: Decision, group: Group, around: Around) -> None:
        assert isinstance(decision, PlumeMapDecision), "this planner belongs to plume-map"
        places = [(own.x, own.y, self._me)]
        # Robots that see another map (their clocks are wrong, say) go their own ways: no line with them.
        ours = decision.company()
        places += [(x, y, j) for (x, y, _, _), j in zip(around.others, around.numbers, strict=True) if j in ours]
        middle = (sum(p[0] for p in places) / len(places), sum(p[1] for p in places) / len(places))
        wind = decision.wind
        p = decision.posterior()
        along = deviation_along(p, *wind) if p else 0.0
        across = deviation_along(p, -wind[1], wind[0]) if p else 0.0
        quiet = own.t - decision.smelt_at
        goal = self._goal(own.t, decision.h, middle, wind, along, across, quiet)
        dx, dy = goal[0] - middle[0], goal[1] - middle[1]
        distance = hypot(dx, dy)
        speed = self._p.speed * min(1.0, distance / SLOW)
        v_c = (speed * dx / distance, speed * dy / distance) if distance > 0.0 else (0.0, 0.0)
        contact = quiet <= self._p.contact
        slot = self._slot(places, middle, wind, across, contact)
        if contact and distance > SLOW:
            slot = self._settling((own.x, own.y), slot)
        self._planned_at = own.t
        mode = LOST if quiet > self._p.lost_after else TRACE
        self._next = Plan(mode, slot, p_dot=v_c, v_c=v_c, centre=decision.h)

    def plan(self, own: Own, h: Point, lost: bool) -> Plan:
        assert self._next is not None, "brief() comes before plan()"
        return self._next

    def follow(self, own: Own, plan: Plan) -> Plan:
        """The place in the line moves on with the line."""
        assert self._next is not None, "brief() comes before follow()"
        age = min(own.t - self._planned_at, AHEAD)
        x, y = self._next.target
        target = (x + age * plan.p_dot[0], y + age * plan.p_dot[1])
        return Plan(plan.mode, target, plan.p_dot, plan.p_ddot, plan.v_c, plan.centre)

    def _goal(
        self, t: float, h: Point, middle: Point, wind: Point, along: float, across: float, quiet: float
    ) -> Point:
        p = self._p
        gx, gy = h
        if quiet <= p.contact and along > SHARP:
            self._upwind, self._leg_since = True, t
        A = min(max(SPREAD * along, p.shuttle_min), p.shuttle_max)
        if hypot(gx - middle[0], gy - middle[1]) < A + NEAR:
            B = self._side * (
                min(max(SPREAD * across, 1.0), p.cast_max) if quiet > p.lost_after else p.sway if along < SHARP else 0.0
            )
            a = -A if self._upwind else A
            gx, gy = gx + a * wind[0] - B * wind[1], gy + a * wind[1] + B * wind[0]
            if hypot(gx - middle[0], gy - middle[1]) < THERE or t - self._leg_since > p.turn_after:
                if not self._upwind:
                    self._side = -self._side
                self._upwind, self._leg_since = not self._upwind, t
        arena, m = self._arena, p.margin
        return (
            min(max(gx, arena.x_min + m), arena.x_max - m),
            min(max(gy, arena.y_min + m), arena.y_max - m),
        )

    def _settling(self, here: Point, slot: Point) -> Point:
        """The place, drawn near, so that the pull towards it is no faster than `settle`."""
        reach = self._p.settle / self._p.pull
        dx, dy = slot[0] - here[0], slot[1] - here[1]
        off = hypot(dx, dy)
        return (here[0] + dx * reach / off, here[1] + dy * reach / off) if off > reach else slot

    def _slot(
        self, places: list[tuple[float, float, int]], middle: Point, wind: Point, across: float, contact: bool
    ) -> Point:
        p, n = self._p, len(places)
        apart = min(max(2.0 * across / max(n - 1, 1), p.spacing_min), p.spacing_max)
        order = sorted((-x * wind[1] + y * wind[0], j) for x, y, j in places)
        if contact and n > 1:
            apart = max(p.spacing_min, min(apart, (order[-1][0] - order[0][0]) / (n - 1)))
        rank = next(r for r, (_, j) in enumerate(order) if j == self._me)
        off = (rank - 0.5 * (n - 1)) * apart
        return middle[0] - off * wind[1], middle[1] + off * wind[0]
