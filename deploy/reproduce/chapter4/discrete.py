"""Figures 4.5-4.7: PSO, GPSO and the printed DFPSO about a resting target, (4.21) with p = 0."""

from __future__ import annotations

from functools import partial
from math import isinf
from typing import TYPE_CHECKING

import numpy as np

from deploy.reproduce.chapter4.dfpso import chatter, particle
from deploy.reproduce.chapter4.fpso import Curve, Gains
from deploy.reproduce.kinds import AGREES, DIFFERS, OURS, Options, Reproduction, Result, Row
from robot_agent.sig import implicit_step

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STEPS = 3000
BAND = 1e-2
SWARMS = {
    "PSO": (Gains(0.8, 2.2), 1.0),  # Figure 4.5
    "GPSO": (Gains(0.8, 2.2), 0.5),  # Figure 4.6
    "DFPSO": (Gains(0.8, 2.2, 0.5, 0.5), 0.5),  # Figure 4.7
}


def swarm(name: str, options: Options) -> Result:
    """How far a particle swings, how soon it settles, and what is left in the end."""
    gains, dk = SWARMS[name]
    curve = particle(gains, dk, STEPS)
    reach = np.abs(curve.y).max(axis=1)
    left = float(np.abs(curve.y[0, -100:]).max())
    others = ", ".join(
        f"{other} {np.abs(particle(g, d, STEPS).y[0]).max():.1f}" for other, (g, d) in SWARMS.items() if other != name
    )
    samples = int(np.flatnonzero(np.abs(curve.y[0]) >= BAND)[-1]) + 1
    rows = [
        Row(
            "largest |x|", "the more, the more it explores", f"{reach[0]:.1f} m", OURS, f"drawn only; the others: {others} m"
        ),
        Row("largest |v|", "", f"{reach[1]:.1f} m/s", OURS, "drawn only"),
        Row(
            f"sampling points until |x| < {BAND:g}",
            "their number refers to the exploiting capability",
            f"{samples} ({samples * dk:g} s)",
            OURS,
            "drawn only",
        ),
    ]
    rows += _residue(gains, dk, left)
    numbers = {"largest": list(map(float, reach)), "samples": samples, "left": left}
    return Result(rows, {"": _picture(name, gains, dk, curve)}, numbers)


def _residue(gains: Gains, dk: float, left: float) -> list[Row]:
    if not gains.beta:
        return [
            Row("converges", "asymptotically", f"|x| = {left:.0e} m after {STEPS} steps", AGREES if left < 1e-9 else DIFFERS)
        ]
    phi, place = chatter(gains, dk)
    damped = particle(gains, dk, STEPS, law=implicit_step)
    settled = damped.settled(1e-9)
    return [
        Row(
            "converges",
            "within a finite-time interval (Proposition 7)",
            f"|x| = {left:.3e} m for ever",
            DIFFERS,
            "sig(φ)^a has an infinite slope at 0: every explicit step overshoots there",
        ),
        Row(
            "what is left, calculated: Δk² g* φ*/4",
            "",
            f"{place:.3e} m, φ* = {phi:.3e}",
            OURS,
            "alternates between two places; g* = 4/(Δk(αΔk + 2(1-ω))), φ* = (β/(g*-γ))^(1/(1-a))",
        ),
        Row(
            "with the robots' implicit step",
            "",
            "does not settle" if isinf(settled) else f"|x|, |v| < 1e-9 after {settled:g} s",
            OURS,
            "no chatter: that step has no gain above what its length can bear",
        ),
    ]


def _picture(name: str, gains: Gains, dk: float, curve: Curve) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14.0, 4.0), layout="constrained")
    axes = figure.subplots(1, 3)
    shown = slice(0, round(80 / dk) + 1)
    for axis, values, label in ((axes[0], curve.y[1], "v, m/s"), (axes[1], curve.y[0], "x, m")):
        axis.plot(curve.t[shown], values[shown], ".-", lw=0.7, ms=3)
        axis.set(xlabel="t, s", ylabel=label)
    size = np.maximum(np.abs(curve.y[0]), 1e-16)
    axes[2].semilogy(curve.t[: shown.stop * 2], size[: shown.stop * 2], ".", ms=2, label="as printed")
    if gains.beta:
        damped = particle(gains, dk, STEPS, law=implicit_step)
        log = np.maximum(np.abs(damped.y[0]), 1e-16)
        axes[2].semilogy(damped.t[: shown.stop * 2], log[: shown.stop * 2], lw=1, label="implicit step")
        axes[2].axhline(chatter(gains, dk)[1], color="k", ls="--", lw=0.8, label="calculated chatter")
        axes[2].legend()
    axes[2].set(xlabel="t, s", ylabel="|x|, m", ylim=(1e-16, 100))
    for axis in axes:
        axis.grid(alpha=0.3)
    figure.suptitle(
        f"{name}: ω = {gains.omega:g}, α = {gains.alpha:g}, γ = {gains.gamma:g}, β = {gains.beta:g}, Δk = {dk:g}"
    )
    return figure


REPRODUCTIONS = tuple(
    Reproduction(f"fig-4.{k}", f"A particle of {name}", f"Figure 4.{k}, {equation}", partial(swarm, name))
    for k, name, equation in ((5, "PSO", "(4.3)"), (6, "GPSO", "(4.5)"), (7, "DFPSO", "(4.23)"))
)
