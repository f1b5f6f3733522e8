"""Example 2, Figure 3.3: the robots' fusion (3.26) follows sin 2t, measured with noise, on the graph of Figure 3.2."""

from __future__ import annotations

from math import sin, sqrt
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from deploy.reproduce.chapter4.pictures import panels
from deploy.reproduce.kinds import AGREES, DIFFERS, OURS, Options, Reproduction, Result, Row
from protocol.randomness import rng_for
from protocol.scenario.sections import Fusion, Timing
from protocol.topology.analysis import laplacian
from protocol.topology.named import build
from robot_agent.fusion import step

Array = NDArray[np.float64]
Form = Literal["implicit", "explicit"]

N, VARIANCE, SECONDS, SETTLED = 4, 0.3, 16.0, 6.0
HOLD = 0.1  # how long a draw of the noise stands, s; the thesis does not say
FINE = 2e-3  # s
FORMS: tuple[Form, ...] = ("implicit", "explicit")
RATE = 2.0  # nu of Proposition 4: |d sin 2t / dt| <= 2


def follow(
    beta: float,
    *,
    seed: int = 0,
    variance: float = VARIANCE,
    topology: str = "fig-3.2",
    dt: float = FINE,
    form: Form = "explicit",
) -> tuple[Array, Array, Array]:
    """t (K,), measurements u (K, N) and fused y (K, N), `dt` apart.

    Args:
        variance: of the noise of a measurement, which is drawn anew every HOLD seconds; 0: none.
        dt: step, s; FINE stands for continuous time.
        form: the step (`fusion.step`).
    """
    graph = build(topology, N)
    adjacency = graph.adjacency()
    degree = max(map(sum, adjacency))
    gains = Fusion(beta=beta, lam=0.8, a=0.5, step=form)
    blocks = round(SECONDS / HOLD) + 1
    noise = [
        [sqrt(variance) * rng_for(seed, "reproduce", "fig-3.3", i, block).normal() for i in range(N)]
        for block in range(blocks)
    ]
    ts, us, ys = [], [], []
    y = [(0.0, 0.0)] * N
    for k in range(round(SECONDS / dt)):
        t = k * dt
        u = [sin(2.0 * t) + w for w in noise[int(t / HOLD + 1e-9)]]
        ts.append(t)
        us.append(u)
        ys.append([value for value, _ in y])
        y = [
            step(y[i], [(a, *y[j]) for j, a in enumerate(adjacency[i]) if a], (u[i], 0.0), gains, degree, dt)
            for i in range(N)
        ]
    return np.array(ts), np.array(us), np.array(ys)


def lag(beta: float, *, dt: float = FINE, form: Form = "explicit") -> float:
    """The largest error without noise, once the start is forgotten."""
    t, _, y = follow(beta, variance=0.0, dt=dt, form=form)
    return float(np.abs(y - np.sin(2.0 * t)[:, None])[t >= SETTLED].max())


def bound(beta: float) -> float:
    """epsilon of Proposition 4, a bound on the 2-norm of the four errors."""
    eigenvalues = np.linalg.eigvalsh(laplacian(build("fig-3.2", N)) + 0.8 * np.eye(N))
    low, high = float(eigenvalues[0]), float(eigenvalues[-1])
    root = sqrt(N)
    return max(RATE * root / (low * (beta + 1.0)), RATE * root / low - beta * root / high)


def example_2(options: Options) -> Result:
    """What the fusion gains over a single measurement, and how well it follows without noise."""
    t, u, y = follow(4.0, seed=options.seed)
    late = t >= SETTLED
    truth = np.sin(2.0 * t)

    def rms(values: Array) -> float:
        return float(np.sqrt(((values - truth[:, None])[late] ** 2).mean()))

    raw, fused = rms(u), rms(y)
    betas = (0.0, 4.0, 8.0)
    quiet = [lag(beta) for beta in betas]
    tick = Timing().tick
    ticked = {form: [lag(beta, dt=tick, form=form) for beta in betas] for form in FORMS}
    norm = quiet[1] * sqrt(N)  # without noise all four robots do the same
    graphs = {name: rms(follow(4.0, seed=options.seed, topology=name)[2]) for name in ("line", "fig-3.2", "all")}
    rows = [
        Row(
            "rms error of the fused data, of the measurements",
            "acts as a low-pass filter (Remark 6)",
            f"{fused:.2f}, {raw:.2f}",
            AGREES if fused < raw else DIFFERS,
            f"noise drawn anew every {HOLD:g} s; the thesis does not say how often",
        ),
        Row(
            "largest error without noise, β = 0, 4, 8",
            "smaller with a larger β (Remark 7)",
            ", ".join(f"{error:.2f}" for error in quiet),
            AGREES if quiet == sorted(quiet, reverse=True) else DIFFERS,
        ),
        Row(
            f"  the same with the robots' tick of {tick:g} s",
            "",
            "; ".join(f"{form} step " + ", ".join(f"{error:.2f}" for error in errors) for form, errors in ticked.items()),
            OURS,
            "the implicit step gives up gain that the tick could not bear on every graph: a signal as fast as this lags; "
            "a source rests",
        ),
        Row(
            "norm of the errors without noise, β = 4",
            f"at most ε = {bound(4.0):.2f} (Proposition 4)",
            f"{norm:.2f}",
            AGREES if norm <= bound(4.0) else DIFFERS,
            "the bound is loose",
        ),
        Row(
            "rms error on a line, a ring (Figure 3.2), a complete graph",
            "",
            ", ".join(f"{value:.2f}" for value in graphs.values()),
            OURS,
            "every robot measures: the graph hardly matters",
        ),
    ]
    figure, axes = panels(2)
    axes[0].plot(t, u[:, 0], lw=0.8, label="u₁")
    axes[1].plot(t, y, lw=0.8)
    for axis, name in zip(axes, ("measured by robot 1", "fused, four robots"), strict=True):
        axis.plot(t, truth, "k--", lw=1, label="sin 2t")
        axis.set(xlabel="t, s", ylim=(-2.6, 2.6), title=name)
        axis.legend()
    numbers = {"rms_raw": raw, "rms_fused": fused, "beta": betas, "largest_quiet": quiet, "at_tick": ticked}
    return Result(rows, {"": figure}, {**numbers, "rms_by_graph": graphs})


REPRODUCTIONS = (Reproduction("fig-3.3", "The fusion follows a signal", "Example 2, Figures 3.2, 3.3", example_2),)
