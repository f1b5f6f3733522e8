"""The pictures of chapter 5: ways of robots, and curves over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

COLOURS = ("C0", "C1", "C2", "C3", "C4")


def ways(axis: Axes, x: Array, *, joined: Sequence[int] = (), title: str = "") -> None:
    """The ways of the robots, x: (K, N, 2); "o" the start, "*" the end, as the thesis marks them.

    Args:
        joined: samples at which the robots are joined by a thin line, so that the formation can be seen.
    """
    for k in joined:
        corners = [*range(x.shape[1]), 0]
        axis.plot(*x[k, corners].T, color="0.75", lw=0.8, zorder=1)
    for i in range(x.shape[1]):
        colour = COLOURS[i % len(COLOURS)]
        axis.plot(*x[:, i].T, color=colour, lw=1.3, label=f"robot {i + 1}")
        axis.plot(*x[0, i], "o", color=colour, mfc="white", ms=7)
        axis.plot(*x[-1, i], "*", color=colour, ms=11)
    axis.set(xlabel="x, m", ylabel="y, m", title=title)
    axis.set_aspect("equal", adjustable="datalim")
    axis.grid(alpha=0.3)


def ways_figure(x: Array, joined: Sequence[int], title: str) -> Figure:
    """One picture of `ways`."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 5.2), layout="constrained")
    axis = figure.subplots()
    ways(axis, x, joined=joined, title=title)
    axis.legend(loc="best", fontsize=8)
    return figure


def decays(t: Array, panels: Mapping[str, Mapping[str, Array]], mark: float | None, line: tuple[float, str]) -> Figure:
    """Errors over time on a logarithmic scale, a panel each.

    Args:
        panels: label of the axis -> name -> (K,).
        mark: the time that the thesis gives, s.
        line: a rate, 1/s, and its name: the straight line that the tail ought to lie along.
    """
    import numpy as np
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.2 * len(panels), 4.2), layout="constrained")
    for axis, (label, curves) in zip(np.atleast_1d(figure.subplots(1, len(panels))), panels.items(), strict=True):
        for name, error in curves.items():
            axis.semilogy(t, np.maximum(error, 1e-16), lw=1.3, label=name)
        middle = len(t) // 2
        anchor = 10.0 * max(float(error[middle]) for error in curves.values())
        axis.semilogy(t, anchor * np.exp(-line[0] * (t - t[middle])), "k:", lw=1, label=line[1])
        if mark is not None:
            axis.axvline(mark, color="0.5", lw=1)
            axis.annotate(f"T = {mark:g}", (mark, 1e-14), xytext=(-4, 0), textcoords="offset points", ha="right", fontsize=8)
        axis.set(xlabel="t, s", ylabel=label, ylim=(1e-15, 1e4))
        axis.legend(loc="upper right", fontsize=8)
        axis.grid(alpha=0.3)
    return figure


def curves_figure(t: Array, panels: Mapping[str, Array], limits: Mapping[str, float]) -> Figure:
    """Curves of all robots over time, a panel each.

    Args:
        panels: label of the axis -> (K, N).
        limits: label -> what the body can do at most, drawn where it is.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.6, 2.3 * ((len(panels) + 1) // 2)), layout="constrained")
    axes = figure.subplots((len(panels) + 1) // 2, 2, sharex=True).ravel()
    for axis, (label, values) in zip(axes, panels.items(), strict=False):
        for i in range(values.shape[1]):
            axis.plot(t, values[:, i], color=COLOURS[i % len(COLOURS)], lw=1.1, label=f"robot {i + 1}")
        if label in limits:
            for sign in (-1, 1):
                if sign * values.max() > 0 or values.min() < 0:
                    axis.axhline(sign * limits[label], color="0.6", lw=0.8, ls="--")
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    for axis in axes[len(panels) :]:
        axis.set_visible(False)
    for axis in axes[len(panels) - 2 : len(panels)]:
        axis.set_xlabel("t, s")
        axis.tick_params(labelbottom=True)
    axes[0].legend(loc="best", fontsize=8)
    return figure
