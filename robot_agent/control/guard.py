"""The guard: a robot never drives so that it could no longer stop clear of the bodies that it senses.

Let P_i(k) be the way that the hand of robot i goes, from tick k on, when its wheels brake with all they have (what the
world does with a body that is lost, too). Two robots are safe at k when P_i(k) and P_j(k) are at least X apart. At each
tick robot i knows of robot j: e, the direction to it; d, its distance; and rho, which is more than the length of P_j(k)
(`Stops`). It calls an order for the wheels *clear* when the way through the tick under it, and the braking after it, stay
behind a line across e that lies
    min((d - X)/2, d - X - rho)
ahead of its hand, for every body sensed; and it does what the law asks if that is clear, the clear order nearest to it if
not, and brakes when there is none.

Claim: whoever is safe at k is safe at k + 1, and no two hands come nearer than X in between. Of two robots
* both do something clear: their ways end behind lines that are (d - X)/2 from the middle, X apart;
* i does something clear and j brakes, stands still, is dead or hangs: j stays on P_j(k), which ends d - rho ahead of i,
  and i stays X short of that;
* both brake: they stay on P_i(k) and P_j(k), which are X apart.
The next tick's P is part of the way that was looked at. No robot needs to know what the other chooses, nor to hear it.

What keeps it from a standstill: two that stand X apart sense each other's speed only up to an error, so that no order is
clear at all. Where the line would lie behind the hand, but d - rho >= X' = X - GIVE, it is put at the hand: the robot may
move away and sideways. The cases above then hold with X' for X (both at the hand: d >= X'), so that X' is what is
promised: `repulsion.keep` = 0.65 m keeps 0.62 m. The line is put there, too, when the other is still nearer and stands, so
that robots that began too near part. The proof leaves a hole of millimetres there: one that seems to stand may go at
0.06 m/s, of which 5 mm are the way to a stop; the orders of both point away from the other.

It holds for every tick, body, speed and goal as long as readings come every tick (lock-step), the range is at least
`range_needed`, X + 2 (rho_max + a tick at top speed), 1.63 m here, all but braking bodies have a guard, and brakes are
what they are said to be. So it does not hold for a robot with a weak wheel (fault `actuator`); in real time a drive that
comes late lengthens the way by what is driven meanwhile. Errors of position and compass do not matter
(robot_agent.proximity), nor does what anybody says.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import ceil, cos, hypot, sin

from protocol.motors import limited, stopping_torques
from protocol.scenario import RobotScenario
from protocol.scenario.sections import Body
from robot_agent.control.stops import Stops
from robot_agent.hand import Own, fastest_hand
from robot_agent.interfaces import Point
from robot_agent.proximity import Sensed

GIVE = 0.03  # m: X - X'
STEPS = 4  # torques that are tried, per wheel, between none and most

Line = tuple[float, float, float]  # n_x, n_y, b: n . p <= b in the frame of the hand, |n| = 1
Torques = tuple[float, float]


class Guard:
    """One robot's last word on what its wheels do."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._body = body = scenario.body
        self._dt = scenario.timing.tick
        self._substeps = max(1, ceil(self._dt / scenario.timing.substep - 1e-9))
        self._keep = scenario.repulsion.keep
        self._stops = Stops(body, self._dt)
        self._far = fastest_hand(body) * self._dt + self._stops.longest
        grid = [body.max_torque * k / STEPS for k in range(-STEPS, STEPS + 1)]
        self._tries = [(left, right) for left in grid for right in grid]
        self.interventions = 0  # ticks at which the law did not get its will

    def permit(self, tau_left: float, tau_right: float, own: Own, bodies: Sequence[Sensed]) -> Torques:
        """The clear torques nearest to those that the law asks for, N m."""
        lines = self._lines(bodies)
        if not lines:
            return tau_left, tau_right
        asked = limited(tau_left, tau_right, self._body)
        if None not in lines:
            known = [line for line in lines if line is not None]
            if self._clear(asked, own, known):
                return tau_left, tau_right
            self.interventions += 1
            for torques in sorted(self._tries, key=lambda each: self._unlike(each, asked)):
                if self._clear(torques, own, known):
                    return torques
        else:
            self.interventions += 1
        return stopping_torques(own.nu, own.omega, self._body, self._dt)

    def _lines(self, bodies: Sequence[Sensed]) -> list[Line | None]:
        """The lines of the bodies that matter; None: nothing but braking is clear of this one."""
        lines: list[Line | None] = []
        X = self._keep
        for body in bodies:
            d = hypot(body.ahead, body.left)
            rho = self._stops.bound(body.fastest)
            b = min(0.5 * (d - X), d - X - rho)
            if b >= self._far:
                continue
            if b < 0.0:
                if d - rho < X - GIVE and not body.stands:
                    lines.append(None)
                    continue
                b = 0.0
            d = max(d, 1e-9)
            lines.append((body.ahead / d, body.left / d, b))
        return lines

    def _unlike(self, torques: Torques, asked: Torques) -> float:
        """How much else the hand would be accelerated than was asked for."""
        left, right = torques[0] - asked[0], torques[1] - asked[1]
        lever = 2.0 * self._body.hand / self._body.axle  # sideways, compared with forward
        return float((left + right) ** 2 + (lever * (right - left)) ** 2)

    def _clear(self, torques: Torques, own: Own, lines: Sequence[Line]) -> bool:
        """Whether the way under `torques` for a tick, and then braking, stays behind all lines."""
        for x, y in way(torques, own.nu, own.omega, self._body, self._dt, self._substeps):
            for nx, ny, b in lines:
                if nx * x + ny * y > b + 1e-9:
                    return False
        return True


def range_needed(body: Body, dt: float, keep: float) -> float:
    """How far a robot must sense others, m: at that distance both may still go at top speed for a tick and then stop."""
    return keep + 2.0 * (Stops(body, dt).longest + fastest_hand(body) * dt)


def way(torques: Torques, nu: float, omega: float, body: Body, dt: float, substeps: int) -> Iterator[Point]:
    """Where the hand goes, in its own frame of now: one tick under `torques`, then ticks of braking until it stands, m."""
    L = body.hand
    x, y, theta = -L, 0.0, 0.0
    forward, turning = body.wheel_radius / (2.0 * body.wheel_inertia), body.wheel_radius / (body.axle * body.wheel_inertia)
    while True:
        left, right = limited(*torques, body)
        h = dt / substeps
        d_nu, d_omega = forward * (left + right) * h, turning * (right - left) * h
        for _ in range(substeps):
            nu_1 = max(-body.max_speed, min(body.max_speed, nu + d_nu))
            omega_1 = max(-body.max_turn, min(body.max_turn, omega + d_omega))
            turn, step = 0.5 * h * (omega + omega_1), 0.5 * h * (nu + nu_1)
            x += step * cos(theta + 0.5 * turn)
            y += step * sin(theta + 0.5 * turn)
            theta += turn
            nu, omega = nu_1, omega_1
        yield x + L * cos(theta), y + L * sin(theta)
        if abs(nu) + abs(omega) < 1e-9:
            return
        torques = stopping_torques(nu, omega, body, dt)
        substeps = 1  # no limit is met while it brakes
