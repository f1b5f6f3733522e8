"""Example 1, Figure 3.1: the robots' Kalman filter with measurements that are noisier than it knows and do not all come.

Read so: the "uncertain measurement noise variance", normal with variance 10.3, is a second noise of that variance; the
filter knows R = 2.1 only. The source's place is not given; with P(0) = 1e3 it hardly matters.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from deploy.reproduce.chapter4.pictures import panels
from deploy.reproduce.kinds import AGREES, DIFFERS, OURS, Options, Reproduction, Result, Row
from protocol.randomness import rng_for
from robot_agent.kalman import Estimate, update

KNOWN, UNKNOWN = 2.1, 10.3  # variances, m^2
ARRIVALS = (0.9, 0.5, 0.1)  # P(lambda_k = 1)
SOURCE = 5.0  # m
RUNS, STEPS = 200, 100


def errors(seed: int, arrival: float) -> tuple[np.ndarray, np.ndarray]:
    """Errors (2 RUNS, STEPS), m, and the filter's own P (RUNS, STEPS), m^2; the two axes are two samples."""
    off = np.empty((2 * RUNS, STEPS))
    own = np.empty((RUNS, STEPS))
    for run in range(RUNS):
        rng = rng_for(seed, "reproduce", "fig-3.1", run)
        estimate = Estimate(0.0, 0.0, 1e3)
        for k in range(STEPS):
            came = rng.uniform() < arrival  # the same draws for every arrival probability
            x, y = (SOURCE + sqrt(KNOWN) * rng.normal() + sqrt(UNKNOWN) * rng.normal() for _ in range(2))
            estimate = update(estimate, (x, y) if came else None, KNOWN)
            off[2 * run : 2 * run + 2, k] = estimate.x - SOURCE, estimate.y - SOURCE
            own[run, k] = estimate.P
    return off, own


def example_1(options: Options) -> Result:
    """The error falls like that of a mean; the filter thinks it smaller than it is."""
    figure, axes = panels(2)
    rows: list[Row] = []
    ends, numbers = [], {}
    for arrival in ARRIVALS:
        off, own = errors(options.seed, arrival)
        rms = np.sqrt((off**2).mean(axis=0))
        theory = sqrt((KNOWN + UNKNOWN) / (arrival * STEPS))
        claims = float(np.sqrt(own[:, -1].mean()))
        ends.append(float(rms[-1]))
        numbers[f"{arrival:g}"] = {"rms_m": ends[-1], "theory_m": theory, "claimed_m": claims}
        axes[0].plot(np.arange(1, STEPS + 1), off[0], lw=1, label=f"P(λ = 1) = {arrival:g}")
        axes[1].loglog(np.arange(1, STEPS + 1), rms, lw=1.2, label=f"P(λ = 1) = {arrival:g}")
        rows.append(
            Row(
                f"error after {STEPS} steps, P(λ = 1) = {arrival:g}",
                "estimates converge",
                f"rms {ends[-1]:.2f} m; mean of {arrival * STEPS:.0f} measurements {theory:.2f} m",
                AGREES if rms[-1] < 0.5 * rms[9] else DIFFERS,
                f"the filter itself claims {claims:.2f} m: it does not know of the second noise",
            )
        )
    rows.append(
        Row(
            "the more measurements arrive, the better",
            "better when the probability increases",
            " < ".join(f"{end:.2f}" for end in ends) + " m",
            AGREES if ends == sorted(ends) else DIFFERS,
        )
    )
    P = Estimate(0.0, 0.0, 1e3)
    for _ in range(10000):
        P = update(P, (0.0, 0.0), KNOWN)
    gain = P.P / (P.P + KNOWN)
    rows.append(
        Row(
            "K(∞) - I is stable, V_1 exists (Proposition 2)",
            "derived",
            f"K = {gain:.0e} after 10000 steps, eigenvalue of K - I: {gain - 1:.4f}",
            DIFFERS,
            "a source that rests has no process noise: P and K go to 0, K - I to -I, which is not stable",
        )
    )
    axes[0].set(xlabel="k", ylabel="error of one robot, m", ylim=(-8, 8), title="one run")
    axes[1].set(xlabel="k", ylabel="rms error, m", title=f"{2 * RUNS} runs")
    axes[1].legend()
    rows.append(Row("the source's place, the runs", "", f"{SOURCE:g} m, {2 * RUNS}", OURS, "not given"))
    return Result(rows, {"": figure}, {"rms": numbers})


REPRODUCTIONS = (
    Reproduction("fig-3.1", "The Kalman filter with what it does not know", "Example 1, Figure 3.1", example_1),
)
