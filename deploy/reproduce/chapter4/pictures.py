"""Panels of the figures of chapter 4."""

from __future__ import annotations

from typing import TYPE_CHECKING

from deploy.reproduce.chapter4.fpso import Curve

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def panels(n: int) -> tuple[Figure, list[Axes]]:
    """A figure with `n` panels in a row."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.0 * n + 1.5, 4.0), layout="constrained")
    axes = [figure.add_subplot(1, n, k + 1) for k in range(n)]
    for axis in axes:
        axis.grid(alpha=0.3)
    return figure, axes


def states(curve: Curve, name: str, other: Curve | None = None) -> Figure:
    """y_1 and y_2 over time."""
    figure, axes = panels(2)
    for k, (axis, label) in enumerate(zip(axes, ("y₁, m", "y₂, m/s"), strict=True)):
        if other is not None:
            axis.plot(other.t, other.y[k], color="0.75", lw=1, label="(4.8)")
        axis.plot(curve.t, curve.y[k], lw=1.2, label="(4.9)" if other else "(4.8)")
        axis.set(xlabel="t, s", ylabel=label)
        if other is not None:
            axis.legend()
    figure.suptitle(name + ", from y₁ = 5 m, y₂ = -9 m/s")
    return figure
