"""Example 4, Figure 6.9: five double integrators and a virtual robot on a circle, (6.5)."""

from __future__ import annotations

from math import cos, sin

import numpy as np

from deploy.reproduce.chapter6.coordination import EXAMPLE_1
from deploy.reproduce.chapter6.virtual_robots import (
    Array,
    Course,
    Follow,
    Vector,
    distances,
    example_potential,
    example_start,
    simulate,
)
from deploy.reproduce.kinds import DIFFERS, OURS, Options, Reproduction, Result, Row

D, R, OMEGA, CENTRE = 2.5, 15.0, 0.1, (9.0, 9.0)  # m, m, rad/s, m
GAINS = EXAMPLE_1._replace(lam=0.5)
UNTIL = 70.0  # s, a little more than one turn


def leader(t: float) -> Vector:
    """h_r, m; theta_r(0) = 0: the thesis gives none."""
    return CENTRE[0] + R * cos(OMEGA * t), CENTRE[1] + R * sin(OMEGA * t)


def rates(t: float) -> tuple[Vector, Vector]:
    """h_r' and h_r''."""
    c, s = cos(OMEGA * t), sin(OMEGA * t)
    return (-R * OMEGA * s, R * OMEGA * c), (-R * OMEGA**2 * c, -R * OMEGA**2 * s)


def make(options: Options) -> Result:
    """Two forms: the leader felt within r only, as printed, and at any distance."""
    courses = {
        cut: simulate(
            example_start(options.seed, robots=5),
            example_potential(D),
            GAINS,
            UNTIL,
            dt=5e-3,
            every=10,
            reference=rates,
            leader=leader,
            cut=cut,
            follow=Follow(),
        )
        for cut in (True, False)
    }
    away = {cut: float(_to_leader(c)[-1].max()) for cut, c in courses.items()}
    off = {cut: _off_centre(c) for cut, c in courses.items()}
    speed_off = float(np.linalg.norm(courses[False].v - _reference_speeds(courses[False]), axis=-1)[-1].max())
    near = (distances(courses[False].x)[-1] + np.where(np.eye(5) > 0, np.inf, 0.0)).min(axis=1)
    result = Result(
        numbers={
            "farthest_from_leader_m": {"cut": away[True], "all": away[False]},
            "circles_off_centre_m": {"cut": off[True], "all": off[False]},
        }
    )
    result.rows = [
        Row(
            "centres of the robots' circles from h^c, leader felt within r = 1.2 d = 3 m",
            "the robots circle the predicted source (Figure 6.9)",
            f"{off[True]:.1f} m; the farthest robot is {away[True]:.1f} m from the leader",
            DIFFERS,
            "J is flat beyond r: robots that start farther away take its velocity, not its place. Section 6.3 has r = 9 m",
        ),
        Row(
            "the same, leader felt at any distance",
            "",
            f"{off[False]:.1f} m; the farthest robot is {away[False]:.1f} m from the leader",
            OURS,
            "what `ftmcs.circle_reach` = all does",
        ),
        Row("velocities from h_r' at the end", "v_i -> h_r'", f"at most {speed_off:.1e} m/s", OURS),
        Row("each robot's nearest one at the end", "d = 2.5 m", f"{near.min():.2f} to {near.max():.2f} m", OURS),
        Row("R omega_0", "15 m, 0.1 rad/s", f"{R * OMEGA:g} m/s", DIFFERS, "the robots of Table 3.2 do 0.8 m/s"),
    ]
    _draw(result, courses)
    return result


def _to_leader(course: Course) -> Array:
    path = np.array([leader(t) for t in course.t])
    gaps: Array = np.linalg.norm(course.x - path[:, None], axis=-1)
    return gaps


def _off_centre(course: Course) -> float:
    """How far the mean place over the last turn is from h^c, at most, m."""
    turn = course.t > course.t[-1] - 2.0 * np.pi / OMEGA
    return float(np.linalg.norm(course.x[turn].mean(axis=0) - CENTRE, axis=-1).max())


def _reference_speeds(course: Course) -> Array:
    return np.array([rates(t)[0] for t in course.t])[:, None]


def _draw(result: Result, courses: dict[bool, Course]) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 5.2), layout="constrained")
    titles = {True: "as printed: h_r is felt within r = 3 m", False: "h_r is felt at any distance"}
    for axes, (cut, course) in zip(figure.subplots(1, 2, sharex=True, sharey=True), courses.items(), strict=True):
        for i in range(5):
            axes.plot(*course.x[:, i].T, lw=0.9, color="goldenrod")
        axes.plot(*np.array([leader(t) for t in course.t]).T, "r", lw=1.5, label="virtual robot h_r")
        axes.plot(*course.x[0].T, "o", mfc="none", color="k", label="start")
        axes.plot(*course.x[-1].T, "k*", ms=9, label="end")
        axes.plot(*leader(float(course.t[-1])), "r*", ms=11)
        axes.plot(*CENTRE, "b+", ms=14, mew=2, label="h^c")
        axes.set(title=f"Figure 6.9, {titles[cut]}", xlabel="x, m", ylabel="y, m", aspect="equal")
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    result.figures[""] = figure


REPRODUCTIONS = (
    Reproduction("fig-6.9", "five robots circle with a virtual one, (6.5)", "Example 4 of chapter 6, Figure 6.9", make),
)
