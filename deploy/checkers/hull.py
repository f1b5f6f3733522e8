"""The fusion never leaves what went into it: disagreement is not made, it only comes in with measurements.

One implicit step of (3.26) (robot_agent.fusion, robot_agent.sig) gives, on each axis,

    y_i+ = y_i + theta (y_bar - y_i),    0 <= theta <= W / K <= 1,
    y_bar = (sum_j a_ij y_j + lam u_i) / W,   W = sum_j a_ij + lam,   K = 2 max_degree + lam,

because dt s' = (phi_0 - phi_1) / K with phi_1 between 0 and phi_0 = W (y_bar - y_i). So y_i+ lies between the smallest
and the largest of the robot's own value, the values it heard and used, and its input. This maximum principle holds for
any graph, loss, delay and number of liars, and leaving values out (a trimmed fusion) does not break it. In between two
ticks the state is kept.
"""

from __future__ import annotations

from deploy.checkers.finding import Facts
from deploy.checkers.history import History, Life
from protocol.history.records import Acted, Point, Sent

ROUNDING = 1e-9  # relative


def fusion_inside_hull(history: History) -> Facts:
    """A fact for every fusion state, on each axis, and one for every state kept from tick to tick."""
    told = {(id(life), s.tick): s for lives in history.lives.values() for life in lives for s in life.sent}
    before: dict[int, Acted] = {}  # by life
    for life, act in history.acts():
        last, before[id(life)] = before.get(id(life)), act
        sent = told.get((id(life), act.tick))
        if act.fusion is None or sent is None:
            continue
        begins = last is None or last.fusion is None
        if not begins and last is not None and last.tick == act.tick - 1:
            kept = last.fusion == sent.fusion
            yield None if kept else _jumped(history, life, act, last.fusion, sent.fusion)
        for axis, name in enumerate("xy"):
            low, high = _hull(act, sent, axis, begins=begins)
            y = act.fusion[axis]
            slack = ROUNDING * (1.0 + max(abs(low), abs(high)))
            if low - slack <= y <= high + slack:
                yield None
            else:
                where = f"outside of [{low:.4f}, {high:.4f}], its own, heard and measured values"
                yield f"robot {life.robot}'s fusion state went to {name} = {y:.4f} m {history.when(act.tick)}, {where}"


def _hull(act: Acted, sent: Sent, axis: int, *, begins: bool) -> tuple[float, float]:
    values = [sent.fusion[axis]]
    if begins:  # the fusion begins at the robot's own place
        values = [(sent.x, sent.y)[axis], *values] if sent.begun else [(sent.x, sent.y)[axis]]
    values += [y_j[axis] for _, _, _, y_j in act.used if y_j is not None]
    if act.mind is not None and act.mind.input is not None:
        values.append(act.mind.input[axis])
    return min(values), max(values)


def _jumped(history: History, life: Life, act: Acted, was: Point | None, now: Point) -> str:
    return f"robot {life.robot}'s fusion state changed from {was} to {now} m before tick {act.tick} without an exchange"


def not_promised(history: History) -> str | None:
    """Why this run did not promise it."""
    if not any(life.fuses for lives in history.lives.values() for life in lives):
        return f"{history.scenario.algorithm} has no fusion"
    if history.scenario.fusion.step == "explicit":
        return 'fusion.step is "explicit": a step of the printed law overshoots'
    return None
