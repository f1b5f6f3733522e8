"""Example 1, Figures 6.1 and 6.2: the coordinating control (6.1) of six virtual robots."""

from __future__ import annotations

import numpy as np

from deploy.reproduce.chapter6.virtual_robots import (
    Array,
    Course,
    distances,
    example_potential,
    example_start,
    settled,
    simulate,
)
from deploy.reproduce.kinds import AGREES, DIFFERS, Options, Reproduction, Result, Row
from robot_agent.control.coordination import Gains

D = 7.0  # m
EXAMPLE_1 = Gains(gamma=0.9, lam=0.0, beta=0.6, q=1.0 / 3.0, row_sum=5.0, stiffness=0.0)  # a = 1
DRAWS = 5


def disagreement(course: Course) -> Array:
    """||v_1 - v_j|| of (6.1), shape (K, 5), m/s."""
    error: Array = np.linalg.norm(course.v_hat[:, 1:] - course.v_hat[:, :1], axis=-1)
    return error


def nearest(course: Course) -> Array:
    """How far the distance of each robot to its nearest one is from d, at most, (K,), m."""
    apart = distances(course.x_hat) + np.where(np.eye(course.x_hat.shape[1]) > 0, np.inf, 0.0)
    error: Array = np.abs(apart.min(axis=2) - D).max(axis=1)
    return error


def make(options: Options) -> Result:
    """Five draws of the initial state; the picture shows the first."""
    courses = [
        simulate(example_start(options.seed * DRAWS + n), example_potential(D), EXAMPLE_1, 10.0) for n in range(DRAWS)
    ]
    agreed = [settled(c.t, disagreement(c).max(axis=1), 1e-2) for c in courses]
    formed = [settled(c.t, nearest(c), 0.05 * D) for c in courses]
    left = [float(nearest(c)[-1]) for c in courses]
    most = [int((np.abs(distances(c.x_hat)[-1] - D) < 0.01 * D).sum(axis=1).max()) for c in courses]
    result = Result(numbers={"velocities_agree_s": agreed, "formation_s": formed, "left_m": left, "neighbours_at_d": most})
    result.rows = [
        Row(
            "velocities agree within 1e-2 m/s",
            "after about 3 s",
            f"{min(agreed):.2f} to {max(agreed):.2f} s",
            AGREES if max(agreed) <= 3.5 else DIFFERS,
            "the thesis gives no initial state: five were drawn",
        ),
        Row(
            "each robot's nearest one within 5 % of d",
            "after about 6 s",
            f"{min(formed):.2f} to {max(formed):.2f} s",
            AGREES if max(formed) <= 6.5 else DIFFERS,
            f"after 10 s at most {max(left):.1e} m are left",
        ),
        Row(
            "robots at distance d from one robot",
            "four of five in Figure 6.2; J has its minimum where ||x_i - x_j|| = d for all",
            f"{min(most)} to {max(most)} for the robot that has most",
            AGREES if max(most) >= 4 else DIFFERS,
            "in the plane at most three robots are all at d from each other: six come to a piece of a triangular lattice,"
            " a local minimum of J",
        ),
        Row("q = (2a-1)/(2a+1) for a = 1", "q > 1/2 in (6.2)", "1/3", DIFFERS, "(6.2) needs a > 3/2; Table 6.1 has q = 0.6"),
    ]
    result.numbers["property_3"] = flat = _flat()
    result.rows.append(
        Row(
            "J <= c sum ||dJ/dx_i||^2",
            "for some c, everywhere (section 6.2.1)",
            f"no c: two robots {flat['apart_m']:g} m apart have J = {flat['J']:.1f} and a gradient of 0",
            DIFFERS,
            "the potential is flat beyond r = 1.2 d = 8.4 m; Proposition 9 holds for robots within r",
        )
    )
    _draw(result, courses[0])
    return result


def _flat() -> dict[str, float]:
    """J and its gradient for two robots beyond the range."""
    from scipy.integrate import quad

    from robot_agent.control.potential import sigma_norm

    J, apart = example_potential(D), 10.0
    energy, _ = quad(J.action, sigma_norm(D, 0.1), sigma_norm(1.2 * D, 0.1))
    slope_x, slope_y = J.slope(0.0, 0.0, apart, 0.0)
    return {"apart_m": apart, "J": float(energy), "gradient": float(np.hypot(slope_x, slope_y))}


def _draw(result: Result, course: Course) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13, 4.2), layout="constrained")
    speeds, gaps, plane = figure.subplots(1, 3, width_ratios=(1, 1, 0.9))
    speeds.semilogy(course.t, disagreement(course), label=[f"j = {j}" for j in range(2, 7)])
    speeds.set(title="Figure 6.1: ‖v₁ − v_j‖, m/s", xlabel="t, s", ylim=(1e-6, 20))
    apart = distances(course.x_hat)
    hub = int((np.abs(apart[-1] - D) < 0.01 * D).sum(axis=1).argmax())
    others = [j for j in range(6) if j != hub]
    gaps.semilogy(course.t, np.abs(apart[:, hub, others] - D), label=[f"j = {j + 1}" for j in others])
    gaps.set(title=f"Figure 6.2: |‖x_{hub + 1} − x_j‖ − d|, m", xlabel="t, s", ylim=(1e-6, 20))
    for axes in (speeds, gaps):
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    places = course.x_hat[-1]
    for i in range(6):
        plane.plot(*course.x_hat[:, i].T, lw=0.8, color="0.6")
        for j in range(i):
            if abs(apart[-1, i, j] - D) < 0.01 * D:
                plane.plot(*places[[i, j]].T, color="C2", lw=2)
    plane.plot(*course.x_hat[0].T, "o", mfc="none", color="k", label="start")
    plane.plot(*places.T, "k*", ms=10, label="end")
    plane.set(title="d = 7 m where there is a green line", xlabel="x, m", ylabel="y, m", aspect="equal")
    plane.legend(fontsize=8)
    result.figures[""] = figure


REPRODUCTIONS = (
    Reproduction("fig-6.1", "six virtual robots under (6.1)", "Example 1 of chapter 6, Figures 6.1, 6.2", make),
)
