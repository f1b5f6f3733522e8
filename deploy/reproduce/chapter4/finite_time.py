"""The claim of Proposition 6: (4.9) comes to rest in a finite time. It does not."""

from __future__ import annotations

import numpy as np

from deploy.reproduce.chapter4.continuous import BAND, FPSO
from deploy.reproduce.chapter4.fpso import Gains, integrate, rate, rates, tail
from deploy.reproduce.chapter4.pictures import panels
from deploy.reproduce.kinds import DIFFERS, OURS, Options, Reproduction, Result, Row
from protocol.scenario.laws import Cfpso


def robot_gains(**changes: float) -> Gains:
    """Table 4.5, as the scenario has it."""
    table = Cfpso()
    values = {name: getattr(table, name) for name in ("omega", "alpha", "gamma", "beta", "a")}
    return Gains(**{**values, **changes})


def proposition_6(options: Options) -> Result:
    """(4.9) is not finite-time: the end of the way is a straight line in the logarithm."""
    cases = {
        "Figure 4.2 (β = 1.9)": FPSO,
        "Table 4.5 (β = 0.01)": robot_gains(),
        "Table 4.5 with β = 1.9": robot_gains(beta=1.9),
    }
    figure, axes = panels(2)
    decades = [10.0**-k for k in range(15)]
    rows, numbers = [], {}
    for name, gains in cases.items():
        curve = tail(gains, 80.0, dt=2e-5, floor=1e-15)
        slope = rate(curve, 1e-9, 1e-14)
        numbers[name] = {"slope_per_s": slope, "alpha/(1-omega)": gains.tail}
        rows.append(
            Row(
                f"log-slope of |y_1| from 1e-9 to 1e-14, {name}",
                "y_1 = y_2 = 0 after a finite time (Proposition 6)",
                f"{slope:.3f} /s; α/(1-ω) = {gains.tail:.3f} /s",
                DIFFERS,
                "exponential: on φ = 0 what is left is (1-ω) y_1' = -α y_1, whatever β and a are",
            )
        )
        every = slice(None, None, max(1, len(curve.t) // 20000))
        (line,) = axes[0].semilogy(curve.t[every], np.maximum(np.abs(curve.y[0]), 1e-16)[every], lw=1.2, label=name)
        axes[1].loglog(decades[1:], rates(curve, decades), "o-", ms=4, color=line.get_color(), label=name)
        axes[1].axhline(gains.tail, color=line.get_color(), ls="--", lw=0.8)
    k_1 = smallest_on_circle(FPSO)
    rows.append(
        Row(
            "k_1, the minimum of ξᵀMξ on the unit circle (4.19)",
            "larger than zero",
            f"{k_1:g}",
            DIFFERS,
            "M of (4.18) has rank 1 and its null vector, made of length 1, lies on the circle: k of (4.20) is 0 and the "
            "bound on the time infinite. Claim 1 mistakes a zero of φ for one of the state",
        )
    )
    with_beta, without = (integrate(robot_gains(beta=b), 80.0, floor=1e-3).settled(BAND) for b in (Cfpso().beta, 0.0))
    rows.append(
        Row(
            f"what β = {Cfpso().beta:g} of Table 4.5 does (|y| < {BAND:g})",
            "",
            f"settles in {with_beta:.1f} s, with β = 0 in {without:.1f} s",
            OURS,
            "the linear part decides: γ(1-ω)/2 = 0.375 /s",
        )
    )
    axes[0].set(
        xlabel="t, s", ylabel="|y₁|, m", xlim=(-1, 52), ylim=(1e-15, 20), title="(4.9): the straight end is exponential"
    )
    axes[0].legend(loc="upper right", fontsize="small")
    axes[1].set(
        xlabel="|y₁|, m",
        ylabel="rate of decay, 1/s",
        xlim=(3.0, 3e-15),
        title="The rate stays at α/(1-ω) (dashed); a finite time needs ∞",
    )
    return Result(rows, {"": figure}, {"tails": numbers, "k_1": k_1})


def smallest_on_circle(g: Gains) -> float:
    """k_1 of (4.19): the smallest eigenvalue of M, which is min xi^T M xi over |xi| = 1."""
    row = np.array([g.alpha, 1.0 - g.omega])
    return float(abs(np.linalg.eigvalsh(np.outer(row, row)).min()))


REPRODUCTIONS = (Reproduction("prop-6", "Is (4.9) finite-time?", "Proposition 6, (4.14)-(4.20)", proposition_6),)
