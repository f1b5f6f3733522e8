"""Example 2, Figures 6.3 and 6.4: the tracking law (6.2) behind a virtual robot at 0.8 m/s, along one axis."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from deploy.reproduce.chapter6.virtual_robots import Array, Follow, settled
from deploy.reproduce.kinds import AGREES, DIFFERS, OURS, Options, Reproduction, Result, Row
from robot_agent.control.tracking import pull

V_HAT = 0.8  # m/s
UNTIL = 12.0  # s


def chase(e1: float, e2: float, p: Follow, dt: float, law_dt: float, until: float = UNTIL) -> tuple[Array, Array]:
    """Times (K,), s, and errors (K, 2): x - x_hat, m, and v - v_hat, m/s; `law_dt` 0 takes the law as printed."""
    path = [(e1, e2)]
    for _ in range(round(until / dt)):
        e2 -= dt * pull(e1, e2, p.k, p.k1, p.q, law_dt)
        e1 += dt * e2
        path.append((e1, e2))
    t: Array = np.arange(len(path), dtype=np.float64) * dt
    return t, np.array(path, dtype=np.float64)


def conditions(p: Follow, sigma: float) -> dict[str, float]:
    """The three forms in which the thesis has the least k, for |v - v_hat| <= sigma."""
    tail = 2.0 * (2.0 - p.q) * p.k1 ** (1.0 / p.q) * sigma + p.k1 - 1.0 / 3.0
    return {
        "text 2^((2+q)/2)": 2.0 ** ((2.0 + p.q) / 2.0) + tail,
        "proof 2^((2+q)/q)": 2.0 ** ((2.0 + p.q) / p.q) + tail,
        "step of the proof 2^(2+q)": 2.0 ** (2.0 + p.q) + tail,
    }


def make(options: Options) -> Result:
    """A robot that starts 1 m from its virtual one, at rest."""
    p = Follow()
    t, errors = chase(1.0, -V_HAT, p, 1e-4, 1e-4)
    far, near = np.abs(errors).T
    x_settled, v_settled = settled(t, far, 1e-4), settled(t, near, 1e-3)
    late_x, late_v = settled(t, far, 1e-6), settled(t, near, 1e-6)
    result = Result(numbers={"x_below_1e-4_s": x_settled, "v_below_1e-3_s": v_settled})
    result.rows = [
        Row(
            "|x - x_hat| < 1e-4 m, from 1 m and rest",
            "after about 5 s",
            f"{x_settled:.2f} s",
            AGREES if 4.0 <= x_settled <= 6.0 else DIFFERS,
            f"the thesis gives no initial state; below 1e-6 m after {late_x:.2f} s",
        ),
        Row(
            "|v - v_hat| < 1e-3 m/s",
            "after about 4 s",
            f"{v_settled:.2f} s",
            AGREES if 3.5 <= v_settled <= 5.5 else DIFFERS,
            f"below 1e-6 m/s after {late_v:.2f} s",
        ),
    ]
    result.numbers["arrival_s"] = arrivals = _arrivals(t, far)
    gaps = [b - a for (_, a), (_, b) in pairwise(arrivals)]
    result.rows.append(
        Row(
            "time for each further factor 10 of |x - x_hat|",
            "finite time: they shrink (Proposition 10)",
            ", ".join(f"{gap:.2f}" for gap in gaps) + " s",
            AGREES if gaps == sorted(gaps, reverse=True) else DIFFERS,
            f"on v = -k1 sig(x)^q by a factor 10^(1-q) = {10 ** (1 - p.q):.2f}; under a linear law all would be equal",
        )
    )
    floors = {f"{dt:g}": _floor(p, dt) for dt in (1e-2, 1e-3)}
    result.numbers["floors"] = floors
    result.rows.append(
        Row(
            "what is left of |v - v_hat| after 12 s in steps of 0.01 s",
            "",
            f"{floors['0.01']['printed']:.1e} m/s as printed, {floors['0.01']['implicit']:.1e} m/s in the implicit step",
            OURS,
            f"in steps of 1 ms {floors['0.001']['printed']:.1e} and {floors['0.001']['implicit']:.1e}:"
            " the printed law chatters, its slope at rest is infinite",
        )
    )
    result.numbers["least_k"] = least = conditions(p, V_HAT)
    result.rows.append(
        Row(
            "least k for |v - v_hat| <= 0.8 m/s",
            "k = 7",
            ", ".join(f"{name}: {value:.2f}" for name, value in least.items()),
            DIFFERS,
            "three forms in the thesis; of these only the inner step is near k = 7",
        )
    )
    _draw(result, t, errors)
    return result


def _arrivals(t: Array, far: Array) -> list[tuple[float, float]]:
    """When |x - x_hat| is below 1e-1, 1e-2, ... for good."""
    return [(10.0**-n, settled(t, far, 10.0**-n)) for n in range(1, 7)]


def _floor(p: Follow, dt: float) -> dict[str, float]:
    """The largest |v - v_hat| in the last second, m/s."""
    return {
        name: float(np.abs(chase(1.0, -V_HAT, p, dt, law_dt)[1][-round(1.0 / dt) :, 1]).max())
        for name, law_dt in (("printed", 0.0), ("implicit", dt))
    }


def _draw(result: Result, t: Array, errors: Array) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 4.2), layout="constrained")
    panels = figure.subplots(1, 2)
    titles = ("Figure 6.3: |x − x̂|, m", "Figure 6.4: |v − v̂|, m/s")
    shown = t <= 8.0
    for axes, error, title in zip(panels, np.abs(errors).T, titles, strict=True):
        axes.semilogy(t[shown][::10], np.maximum(error[shown][::10], 1e-12), label="from 1 m and rest, dt = 0.1 ms")
        axes.set(title=title, xlabel="t, s", ylim=(1e-10, 3))
        axes.grid(alpha=0.3)
    panels[0].semilogy(t[shown][::10], 10.0 ** -t[shown][::10], "--", color="0.6", label="a factor 10 a second")
    for axes in panels:
        axes.legend(fontsize=8)
    result.figures[""] = figure


REPRODUCTIONS = (
    Reproduction("fig-6.3", "one robot behind its virtual one, (6.2)", "Example 2 of chapter 6, Figures 6.3, 6.4", make),
)
