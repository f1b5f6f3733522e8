"""Example 3, Figures 6.5 to 6.7: six double integrators behind virtual robots under (6.3), v_c = (-1.9, 1.9) m/s."""

from __future__ import annotations

import numpy as np

from deploy.reproduce.chapter6.coordination import EXAMPLE_1, D
from deploy.reproduce.chapter6.virtual_robots import (
    Array,
    Course,
    Follow,
    distances,
    example_potential,
    example_start,
    settled,
    simulate,
)
from deploy.reproduce.kinds import OURS, Options, Reproduction, Result, Row

V_C = (-1.9, 1.9)  # m/s
GAINS = EXAMPLE_1._replace(lam=0.5)
DRAWS = 3


def late(course: Course) -> Array:
    """||v_i - v_c|| of the real robots, shape (K, N), m/s."""
    error: Array = np.linalg.norm(course.v - V_C, axis=-1)
    return error


def make(options: Options) -> Result:
    """Three draws of the initial state; the picture shows the first."""
    courses = [
        simulate(
            example_start(options.seed * DRAWS + n),
            example_potential(D),
            GAINS,
            14.0,
            reference=lambda t: (V_C, (0.0, 0.0)),
            follow=Follow(),
        )
        for n in range(DRAWS)
    ]
    slow = [settled(c.t, late(c).max(axis=1), 0.05) for c in courses]
    lags = [float(np.abs(c.x - c.x_hat).max(axis=(1, 2))[-1]) for c in courses]
    gaps = [_nearest(c) for c in courses]
    result = Result(numbers={"v_c_within_0.05_s": slow, "lag_m": lags, "nearest_gap_m": gaps})
    result.rows = [
        Row(
            "real velocities within 0.05 m/s of v_c",
            "Figure 6.6, a curve; no time is named",
            f"from {min(slow):.1f} to {max(slow):.1f} s on",
            OURS,
            "three initial states were drawn; the thesis gives none",
        ),
        Row("real behind virtual places after 14 s", "", f"at most {max(lags):.1e} m", OURS),
        Row(
            "each real robot's nearest one after 14 s",
            "d = 7 m (Figure 6.7)",
            f"d to within {max(gaps):.1e} m",
            OURS,
        ),
    ]
    _draw(result, courses[0])
    return result


def _nearest(course: Course) -> float:
    apart = distances(course.x[-1:])[0] + np.where(np.eye(course.x.shape[1]) > 0, np.inf, 0.0)
    return float(np.abs(apart.min(axis=1) - D).max())


def _draw(result: Result, course: Course) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13, 4.2), layout="constrained")
    plane, speeds, gaps = figure.subplots(1, 3)
    for i in range(6):
        plane.plot(*course.x[:, i].T, lw=1)
    plane.plot(*course.x[0].T, "o", mfc="none", color="k", label="start")
    plane.plot(*course.x[-1].T, "k*", ms=9, label="end")
    plane.set(title="Figure 6.5: real robots", xlabel="x, m", ylabel="y, m", aspect="equal")
    speeds.semilogy(course.t, late(course), label=[f"i = {i}" for i in range(1, 7)])
    speeds.set(title="Figure 6.6: ‖v_i − v_c‖, m/s", xlabel="t, s", ylim=(1e-6, 20))
    apart = distances(course.x)
    hub = int((np.abs(apart[-1] - D) < 0.01 * D).sum(axis=1).argmax())
    beside = [j for j in range(6) if abs(apart[-1, hub, j] - D) < 0.01 * D]
    gaps.semilogy(course.t, np.abs(apart[:, hub, beside] - D), label=[f"j = {j + 1}" for j in beside])
    gaps.set(title=f"Figure 6.7: |‖x_{hub + 1} − x_j‖ − d|, m", xlabel="t, s", ylim=(1e-6, 20))
    for axes in (plane, speeds, gaps):
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    result.figures[""] = figure


REPRODUCTIONS = (
    Reproduction("fig-6.5", "six robots in parallel motion, (6.3)", "Example 3 of chapter 6, Figures 6.5 to 6.7", make),
)
