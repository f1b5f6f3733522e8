"""The potential-based finite-time motion control of chapter 6 (FTMCS), Algorithm 5.

A virtual robot moves by (6.4) while the group traces and by (6.5) while it is lost; the real one follows by (6.2). The
virtual robot is integrated on board and told to the neighbours; they feel each other's virtual robots.

Thesis (6.5), circular motion: (6.4) with w = h_r', h_r = h^ic + R (cos theta_r, sin theta_r), theta_r' = omega_0, and a
further robot at h_r in the potential.

Departs from the thesis, each a switch of the table `ftmcs`:
  reference    While the group traces, v_c^i counts only of the robot that met the odour last: lambda = 0 for the others,
               who follow by consensus. With everyone's the group moves at the mean of what points from all sides to h,
               ever slower the nearer it comes, and it is the middle of the formation that is led along the plume,
               whether a robot is there or not.
  centre       A lost group circles where the odour was met last: there is a plume, and the circle crosses it. Where h^ic
               is wrong a circle about it may cross nothing, and without odour h^ic does not change.
  circle_reach The robot at h_r is felt at any distance. J is flat beyond r = 1.2 d = 3 m: robots farther away would
               take its velocity only and circle wherever they are.
  turn         omega_0 such that R omega_0 can be driven; theta_r = omega_0 t by the common simulated time, so that no
               phase has to be agreed.
  limited, leash  The virtual robot moves no faster than a real one and stays near it: it has no torques that saturate
               and would run away from a robot that has.
  repulsion    (3.35) is added when somebody is within `clearance`: where the graph is not complete the potential does
               not see everyone.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, sin

from msgspec.structs import replace

from protocol.messages import NEVER, Shared
from protocol.scenario import RobotScenario
from protocol.scenario.laws import Ftmcs
from robot_agent.control.coordination import Gains, Virtual, accelerate, descend
from robot_agent.control.potential import Potential
from robot_agent.control.repulsion import keep_clear
from robot_agent.control.tracking import pull
from robot_agent.hand import Own, top_acceleration
from robot_agent.interfaces import LOST, SEARCH, TRACE, Controller, Fresh, Plan, Point
from robot_agent.neighbours import Placed
from robot_agent.sig import STEPS

NOWHERE = (NEVER, 0.0, 0.0)
FASTEST = 10.0  # times the top speed of a body: no virtual robot of (6.4), (6.5) gets there
TOLD = 7  # numbers in `virtual`: the virtual robot's four, and the latest smell's time and place


class FtmcsControl(Controller):
    """(6.4) while the group traces, (6.5) while it is lost, (6.2) always."""

    def __init__(self, scenario: RobotScenario) -> None:
        p = scenario.ftmcs
        self._p = p
        self._trace = potential(p, p.d)
        self._circle = potential(p, p.circle_d)
        self._row_sum = scenario.max_degree
        self._implicit = scenario.control.step == "implicit"
        self._step = STEPS[scenario.control.step]
        self._trust = scenario.trust
        self._top_speed = scenario.body.max_speed
        self._top = top_acceleration(scenario.body)
        self._keep = replace(scenario.repulsion, d=p.clearance)
        self._threshold = scenario.decision.threshold
        self._ticks_per_decision = round(scenario.timing.decision / scenario.timing.tick)
        self._own_smell = NEVER  # when this robot met the odour last, s
        self._smell = NOWHERE  # when and where anyone did, as far as this robot has heard
        self._me: Virtual | None = None
        self._searching = True

    def virtual(self) -> tuple[float, ...]:
        return () if self._me is None else (*self._me, *self._smell)

    def believes(self, own: Own, state: Shared) -> bool:
        """The virtual robot is on its leash and no faster than the law makes it, the smell not of the future."""
        if len(state.virtual) < TOLD:
            return True
        trust = self._trust
        x, y, vx, vy, at = state.virtual[:5]
        leash = self._p.leash
        on_leash = leash == 0.0 or hypot(x - state.x, y - state.y) <= leash + trust.slack
        return on_leash and hypot(vx, vy) <= FASTEST * self._top_speed and at <= own.t + trust.skew

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        p = self._p
        searching = plan.mode == SEARCH
        if self._me is None or (self._searching and not searching and p.search == "free"):
            self._me = Virtual(own.x, own.y, own.vx, own.vy)  # Algorithm 5: initialize x_hat_i(0), v_hat_i(0)
        self._searching = searching
        me = self._me
        heard = [(a_ij, virtual_of(s, own.tick, dt)) for a_ij, s in fresh]
        self._smell_now(own, fresh)
        if self._circles(plan):
            self._me, acceleration = self._turn(me, heard, own, plan, dt)
        else:
            form = not searching or p.search == "parallel"
            self._me, acceleration = self._parallel(me, heard, plan, dt, self._leads(plan), form)
        step = dt if self._implicit else 0.0
        u = (
            acceleration[0] - pull(own.x - me.x, own.vx - me.vx, p.k, p.k1, p.q, step),
            acceleration[1] - pull(own.y - me.y, own.vy - me.vy, p.k, p.k1, p.q, step),
        )
        self._me = self._leashed(self._me, own, dt)
        return keep_clear(u, own, others, self._keep, self._top) if p.repulsion else u

    def _circles(self, plan: Plan) -> bool:
        """Whether (6.5) rules: Algorithm 5."""
        return plan.mode == LOST

    def _smell_now(self, own: Own, fresh: Fresh) -> None:
        """Remember the latest meeting with the odour in the group: it travels from neighbour to neighbour."""
        if own.concentration > self._threshold and own.due(self._ticks_per_decision):
            self._own_smell = own.t
            self._smell = max(self._smell, (own.t, own.x, own.y))
        for _, s in fresh:
            if len(s.virtual) >= TOLD:
                at, x, y = s.virtual[4:TOLD]
                self._smell = max(self._smell, (at, x, y))

    def _leads(self, plan: Plan) -> bool:
        """Whether this robot's own v_c^i counts: while the group traces, that of whoever smelt last."""
        return self._p.reference == "all" or plan.mode != TRACE or self._own_smell >= self._smell[0]

    def _parallel(
        self, me: Virtual, heard: list[tuple[float, Virtual]], plan: Plan, dt: float, leads: bool, form: bool
    ) -> tuple[Virtual, Point]:
        """(6.4)."""
        p = self._p
        slope = self._slope(self._trace, me, heard) if form else (0.0, 0.0)
        gains = self._gains(p.lam if leads else 0.0, p.beta, self._trace.stiffness * 2.0 * len(heard))
        acceleration = accelerate(me, heard, plan.v_c, (0.0, 0.0), gains, self._step, dt)
        return self._move(me, acceleration, descend(slope, gains, self._step, dt), dt), acceleration

    def _turn(
        self, me: Virtual, heard: list[tuple[float, Virtual]], own: Own, plan: Plan, dt: float
    ) -> tuple[Virtual, Point]:
        """(6.5)."""
        p = self._p
        theta, omega = p.turn * own.t, p.turn
        arm_x, arm_y = p.circle * cos(theta), p.circle * sin(theta)
        slope_x, slope_y = self._slope(self._circle, me, heard)
        at, c_x, c_y = self._smell
        if p.centre == "decided" or at == NEVER:
            c_x, c_y = plan.centre
        x, y = self._circle.slope(me.x, me.y, c_x + arm_x, c_y + arm_y, cut=p.circle_reach == "cut")
        gains = self._gains(p.circle_lam, p.circle_beta, self._circle.stiffness * (2.0 * len(heard) + 1.0))
        h_r_dot = (-omega * arm_y, omega * arm_x)
        h_r_ddot = (-omega * omega * arm_x, -omega * omega * arm_y)
        acceleration = accelerate(me, heard, h_r_dot, h_r_ddot, gains, self._step, dt)
        return self._move(me, acceleration, descend((slope_x + x, slope_y + y), gains, self._step, dt), dt), acceleration

    def _gains(self, lam: float, beta: float, stiffness: float) -> Gains:
        return Gains(self._p.gamma, lam, beta, self._p.q, self._row_sum, stiffness)

    @staticmethod
    def _slope(potential: Potential, me: Virtual, heard: list[tuple[float, Virtual]]) -> Point:
        """dJ/dx_hat_i by the neighbours."""
        slope_x = slope_y = 0.0
        for _, other in heard:
            x, y = potential.slope(me.x, me.y, other.x, other.y)
            slope_x += x
            slope_y += y
        return slope_x, slope_y

    def _move(self, me: Virtual, acceleration: Point, drift: Point, dt: float) -> Virtual:
        """x_hat_i and v_hat_i at the end of the step."""
        vx, vy = me.vx + dt * acceleration[0], me.vy + dt * acceleration[1]
        rate_x, rate_y = vx + drift[0], vy + drift[1]
        if self._p.limited and (speed := hypot(rate_x, rate_y)) > self._top_speed:
            rate_x *= self._top_speed / speed
            rate_y *= self._top_speed / speed
        return Virtual(me.x + dt * rate_x, me.y + dt * rate_y, vx, vy)

    def _leashed(self, me: Virtual, own: Own, dt: float) -> Virtual:
        """The virtual robot, no farther than the leash from where the real one will be."""
        leash = self._p.leash
        dx, dy = me.x - own.x - dt * own.vx, me.y - own.y - dt * own.vy
        away = hypot(dx, dy)
        if leash == 0.0 or away <= leash:
            return me
        back = 1.0 - leash / away
        return Virtual(me.x - back * dx, me.y - back * dy, me.vx, me.vy)


def potential(p: Ftmcs, d: float) -> Potential:
    """The scenario's potential with rest distance `d`, m."""
    return Potential(d, p.reach * d, p.attack, p.defence, p.epsilon, p.h)


def virtual_of(s: Shared, tick: int, dt: float) -> Virtual:
    """A neighbour's virtual robot at `tick`; its real state, which is that of now already, while it has told none."""
    if len(s.virtual) < TOLD:
        return Virtual(s.x, s.y, s.vx, s.vy)
    x, y, vx, vy = s.virtual[:4]
    age = (tick - s.tick) * dt
    return Virtual(x + age * vx, y + age * vy, vx, vy)
