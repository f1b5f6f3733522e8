"""States that come late: a control law sees its neighbours where they are by now (`control.foresee`)."""

from types import SimpleNamespace

import pytest
from judging_helpers import DT, told, view

from robot_agent.control.dcs import DcsControl
from robot_agent.interfaces import TRACE, Plan
from robot_agent.neighbours import Neighbours


def test_a_late_state_is_moved_on_at_its_velocity_and_says_the_rest_as_it_was():
    neighbours = Neighbours(view(topology="all"))
    late = told(1, 4, x=60.0, y=5.0, vx=0.6, vy=-0.8)
    neighbours.hear(10, [late, told(2, 10)])
    (_, moved), (_, of_now) = neighbours.present(10)
    assert (moved.x, moved.y) == pytest.approx((60.0 + 6 * DT * 0.6, 5.0 - 6 * DT * 0.8))
    assert (moved.tick, moved.vx, moved.vy, moved.fusion_x) == (4, 0.6, -0.8, late.fusion_x)
    assert of_now is neighbours.fresh[1][1]
    assert neighbours.fresh[0][1] is late, "what the decision is given stays as it was told"


def test_states_of_now_are_used_as_they_are_and_the_switch_leaves_late_ones_too():
    neighbours = Neighbours(view(topology="all"))
    neighbours.hear(10, [told(1, 10), told(2, 10)])
    assert neighbours.present(10) is neighbours.fresh
    as_told = Neighbours(view(topology="all", control__foresee=False))
    as_told.hear(10, [told(1, 4)])
    assert as_told.present(10) is as_told.fresh


def group_speed(late, *, foresee):
    """How fast a group of three under (5.5) is in the end, whose states come `late` ticks late; v_c is 0.8 m/s."""
    values = {"topology": "all", "robots": 3, "algorithm": "dcs", "dcs__repulsion": False, "control__foresee": foresee}
    views = [view(i, **values) for i in range(3)]
    laws = [DcsControl(v) for v in views]
    memories = [Neighbours(v) for v in views]
    plan = Plan(TRACE, (0.0, 0.0), v_c=(-0.8, 0.0))
    bodies = [SimpleNamespace(tick=0, t=0.0, x=90.0, y=4.0 * i, vx=0.0, vy=0.0) for i in range(3)]
    told_at = []
    for k in range(2500):
        told_at.append([told(i, k, b.x, b.y, vx=b.vx, vy=b.vy) for i, b in enumerate(bodies)])
        us = []
        for i, body in enumerate(bodies):
            body.tick, body.t = k, k * DT
            memories[i].hear(k, [s for s in told_at[max(0, k - late)] if s.robot != i])
            us.append(laws[i].control(body, memories[i].present(k), (), plan, DT))
        for body, (u_x, u_y) in zip(bodies, us, strict=True):
            body.x, body.y = body.x + DT * body.vx + 0.5 * DT**2 * u_x, body.y + DT * body.vy + 0.5 * DT**2 * u_y
            body.vx, body.vy = body.vx + DT * u_x, body.vy + DT * u_y
    return -sum(b.vx for b in bodies) / 3


@pytest.mark.parametrize("late", [2, 6, 10])
def test_a_formation_that_hears_itself_late_holds_itself_back_unless_it_foresees(late):
    p = view(algorithm="dcs").dcs
    tau = late * DT
    assert group_speed(late, foresee=False) == pytest.approx(0.8 / (1.0 + 2 * p.beta * tau / p.lam), rel=0.05)
    assert group_speed(late, foresee=True) == pytest.approx(0.8, rel=0.05)
