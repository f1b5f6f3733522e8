"""Nobody drove after the safe stop: whose body is braked or who is lost comes to rest and stays there.

The rim of each wheel, v = nu -+ omega l / 2, slows down at b tau_max / J_wheel until it stands: from tick to tick |v| of
neither wheel grows, and after (max_speed + l max_turn / 2) / (b tau_max / J_wheel) s both stand still. No drive of a robot
that was lost is taken. A robot with a weak wheel (fault `actuator`) is turned by its own brakes and left out.
"""

from __future__ import annotations

from itertools import pairwise
from math import ceil

from deploy.checkers.finding import Facts
from deploy.checkers.history import History
from protocol.history.records import Pose
from protocol.scenario.faults import Actuator

STILL = 1e-9  # m/s


def stays_stopped(history: History) -> Facts:
    """A fact for every robot and tick at which it is held."""
    body = history.scenario.body
    weak = {fault.robot for fault in history.scenario.faults if isinstance(fault, Actuator)}
    fastest = body.max_speed + 0.5 * body.axle * body.max_turn
    slowing = body.wheel_radius * body.max_torque / body.wheel_inertia
    patience = ceil(fastest / slowing / history.dt) + 1
    held: dict[int, int] = {}  # robot -> ticks on end
    for before, after in pairwise(history.moved):
        held = {i: held.get(i, 0) + 1 for i in {*after.braked, *after.dead}}
        taken = {i for i, _, _ in after.drives}
        for i in sorted(held.keys() - weak):
            when = history.when(after.tick)
            now, then = _rims(after.poses[i], body.axle), _rims(before.poses[i], body.axle)
            if i in after.dead and i in taken:
                yield f"robot {i} was lost, but a drive of it was taken {when}"
            elif any(v_1 > v_0 + STILL for v_0, v_1 in zip(then, now, strict=True)):
                speeds = f"from {max(then):.4f} to {max(now):.4f} m/s"
                yield f"robot {i} was to stand still, but a wheel went {speeds} {when}"
            elif held[i] >= patience and max(now) > STILL:
                still = f"a wheel still went {max(now):.4f} m/s"
                yield f"robot {i} was held for {held[i] * history.dt:.2f} s, but {still} {when}"
            else:
                yield None


def _rims(pose: Pose, axle: float) -> tuple[float, float]:
    """Speed of each wheel's rim, m/s."""
    _, _, _, nu, omega = pose
    return abs(nu - 0.5 * axle * omega), abs(nu + 0.5 * axle * omega)
