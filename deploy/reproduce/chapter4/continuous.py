"""Figures 4.1-4.4: the particle swarm (4.8) beside the finite-time one (4.9)."""

from __future__ import annotations

import numpy as np

from deploy.reproduce.chapter4.fpso import Curve, Gains, implicit, integrate
from deploy.reproduce.chapter4.pictures import panels, states
from deploy.reproduce.kinds import AGREES, DIFFERS, OURS, Options, Reproduction, Result, Row
from protocol.scenario.sections import Timing

PSO = Gains(omega=0.8, alpha=6.0)  # Figure 4.1
FPSO = Gains(omega=0.8, alpha=6.0, gamma=0.5, beta=1.9)  # Figure 4.2
BAND = 1e-2  # "has converged": |y_1| and |y_2| below this, m and m/s; the thesis names no band
WINDOW = 20.0  # s, of the average of Figure 4.3; the thesis does not say


def figure_4_1(options: Options) -> Result:
    """(4.8) oscillates and decays with (1 - omega)/2."""
    curve = integrate(PSO, 120.0, floor=1e-3)
    envelope = decay(curve)
    rows = [
        Row(
            "rate of decay",
            "asymptotically stable for omega < 1, alpha > 0",
            f"{envelope:.3f} /s; (1-omega)/2 = {0.5 * (1 - PSO.omega):.3f} /s",
            AGREES,
        ),
        settling("(4.8)", curve),
        peaks("(4.8)", curve),
    ]
    return Result(rows, {"": states(curve, "(4.8), particle swarm")}, {"decay_per_s": envelope})


def figure_4_2(options: Options) -> Result:
    """(4.9) settles sooner from the same start."""
    before, after = integrate(PSO, 120.0, floor=1e-3), integrate(FPSO, 60.0, floor=1e-3)
    slow, fast = before.settled(BAND), after.settled(BAND)
    reach_before, reach_after = np.abs(before.y).max(axis=1), np.abs(after.y).max(axis=1)
    dt = Timing().tick
    stepped = implicit(FPSO, 60.0, dt=dt).settled(BAND)
    rows = [
        Row(
            f"(4.9) settles before (4.8), |y| < {BAND:g}",
            "the states of (4.8) shall rapidly converge",
            f"{fast:.1f} s against {slow:.1f} s",
            AGREES if fast < slow else DIFFERS,
        ),
        Row(
            "largest |y_1|",
            "gamma enlarges the oscillation",
            f"{reach_after[0]:.2f} m against {reach_before[0]:.2f} m",
            AGREES if reach_after[0] > reach_before[0] else DIFFERS,
        ),
        Row(
            "largest |y_2|",
            "gamma enlarges the oscillation",
            f"{reach_after[1]:.2f} m/s against {reach_before[1]:.2f} m/s",
            AGREES if reach_after[1] > reach_before[1] else DIFFERS,
            "reached in the first swing, where β sig(φ)^a does not quite make up for the smaller γ",
        ),
        Row(
            "(4.9) in the robots' implicit step",
            "",
            f"settles in {stepped:.1f} s with a tick of {dt:g} s",
            OURS,
            "the step that keeps the law from chattering costs a little time",
        ),
    ]
    return Result(
        rows, {"": states(after, "(4.9), finite-time particle swarm", before)}, {"settled_s": [slow, fast, stepped]}
    )


def figure_4_3(options: Options) -> Result:
    """The mean |y_2| over gamma, beta = 0.1."""
    gammas = [round(0.1 * k, 1) for k in range(1, 11)]
    means: dict[float, list[float]] = {}
    for window in (5.0, WINDOW, 40.0):
        means[window] = [float(np.abs(curve.y[1]).mean()) for curve in _over("gamma", gammas, 0.1, window)]
    row, short = means[WINDOW], means[5.0]
    rows = [
        Row(
            f"mean |y_2| over the first {WINDOW:g} s, gamma 0.1 to 1",
            "increasing gamma decreases the average oscillation",
            f"falls from {row[0]:.2f} to {row[-1]:.2f} m/s",
            AGREES if np.all(np.diff(row) < 0) else DIFFERS,
            "the thesis does not name the window",
        ),
        Row(
            "the same over the first 5 s",
            "the same claim",
            f"from {short[0]:.2f} to {short[-1]:.2f} m/s",
            AGREES if np.all(np.diff(short) < 0) else DIFFERS,
            "a larger gamma swings faster before it decays sooner: the claim needs a window of 10 s and more",
        ),
    ]
    figure, axes = panels(1)
    for window, values in means.items():
        axes[0].plot(gammas, values, "o-", label=f"first {window:g} s")
    axes[0].set(xlabel="γ", ylabel="mean |y₂|, m/s", title="Figure 4.3: mean |y₂| of (4.9), β = 0.1")
    axes[0].legend()
    return Result(rows, {"": figure}, {"gamma": gammas, "mean_y2": {f"{w:g} s": v for w, v in means.items()}})


def figure_4_4(options: Options) -> Result:
    """The settling time over beta, gamma = 1."""
    betas = [0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0]
    curves = [integrate(Gains(0.8, 6.0, 1.0, beta), 120.0, floor=3e-4, tolerance=1e-8) for beta in betas]
    times = {band: [curve.settled(band) for curve in curves] for band in (1e-2, 1e-3)}
    row = times[1e-3]
    rows = [
        Row(
            "convergence time (|y| < 1e-3), beta 0.1 to 4",
            "increasing beta decreases the convergence time",
            f"falls from {row[0]:.0f} to {row[-1]:.0f} s",
            AGREES if np.all(np.diff(row) < 0) else DIFFERS,
            "the thesis names no band; with 1e-2 it falls from {:.0f} to {:.0f} s".format(*np.array(times[1e-2])[[0, -1]]),
        )
    ]
    figure, axes = panels(1)
    for band, values in times.items():
        axes[0].plot(betas, values, "o-", label=f"|y| < {band:g}")
    axes[0].set(xlabel="β", ylabel="settling time, s", title="Figure 4.4: settling time of (4.9), γ = 1", ylim=(0, None))
    axes[0].legend()
    return Result(rows, {"": figure}, {"beta": betas, "settled_s": {f"{b:g}": v for b, v in times.items()}})


def decay(curve: Curve) -> float:
    """The rate at which the peaks of |y_1| fall, 1/s."""
    size = np.abs(curve.y[0])
    top = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
    return float(-np.polyfit(curve.t[top], np.log(size[top]), 1)[0])


def settling(name: str, curve: Curve) -> Row:
    """When it has settled."""
    return Row(f"{name} settles, |y| < {BAND:g}", "", f"{curve.settled(BAND):.1f} s", OURS, "drawn only, no number given")


def peaks(name: str, curve: Curve) -> Row:
    """How far it swings."""
    y1, y2 = np.abs(curve.y).max(axis=1)
    return Row(f"{name} swings to", "", f"{y1:.2f} m, {y2:.2f} m/s", OURS, "drawn only, no number given")


def _over(name: str, values: list[float], beta: float, window: float) -> list[Curve]:
    return [
        integrate(Gains(0.8, 6.0, **{"gamma": 1.0, "beta": beta, name: value}), window, tolerance=1e-8) for value in values
    ]


REPRODUCTIONS = (
    Reproduction("fig-4.1", "The particle swarm in continuous time", "Figure 4.1, (4.8)", figure_4_1),
    Reproduction("fig-4.2", "The finite-time particle swarm in continuous time", "Figure 4.2, (4.9)", figure_4_2),
    Reproduction("fig-4.3", "Mean oscillation over γ", "Figure 4.3, (4.9)", figure_4_3),
    Reproduction("fig-4.4", "Settling time over β", "Figure 4.4, (4.9)", figure_4_4),
)
