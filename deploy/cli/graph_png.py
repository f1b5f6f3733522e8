"""A graph as an image file, and one that changes as a row of graphs over a curve.

Rules: matplotlib without a display and without global state; it is loaded when the first image is drawn.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from deploy.cli.graph_layout import places
from deploy.cli.graph_stages import Stages
from protocol.topology.graph import Graph

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_PANELS = 6
GAP = "0.85"  # what colours the times when the graph was not connected


def save_png(graph: Graph, title: str, file: Path) -> None:
    """Draw `graph` into `file`; an arrow points at the robot that listens.

    Raises: OSError when the file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6, 6), layout="constrained")
    FigureCanvasAgg(figure)
    _draw(figure.add_subplot(), graph, title)
    figure.savefig(file, format="png", dpi=120)


def save_stages_png(stages: Stages, title: str, file: Path) -> None:
    """Draw the stages (different ones, the first few) side by side, and below them lambda_2 over time.

    Raises: OSError when the file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    different = {(part.stage.name, part.graph.edges): part for part in reversed(stages.parts)}
    parts = sorted(different.values(), key=lambda part: part.stage.at)[:MOST_PANELS]
    width = max(len(parts), 2)
    figure = Figure(figsize=(3.4 * width, 6.4), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(2, width, height_ratios=(3.2, 2.4))
    for column, part in enumerate(parts):
        reach = f" within {part.stage.range:g} m, at the start" if part.stage.range else ""
        cell = grid[0, :] if len(parts) == 1 else grid[0, column]
        value = part.analysis.lambda_2 or 0.0
        _draw(figure.add_subplot(cell), part.graph, f"{part.stage.name}{reach}\nλ₂ = {value:.3g}", small=True)
    _curve(figure.add_subplot(grid[1, :]), stages)
    figure.suptitle(title if len(title) <= 90 else title[:87] + "...")
    figure.savefig(file, format="png", dpi=120)


def _curve(axes: Axes, stages: Stages) -> None:
    over = stages.over_time
    axes.step([t for t, _, _ in over], [value for _, value, _ in over], where="post", color="tab:blue", linewidth=1.5)
    shaded = False
    for (t, _, whole), (end, _, _) in pairwise(over):
        if not whole:
            axes.axvspan(t, end, color=GAP, linewidth=0, label=None if shaded else "not connected")
            shaded = True
    if len(stages.parts) > 1 and stages.period and stages.mean.lambda_2 is not None:
        axes.axhline(stages.mean.lambda_2, color="tab:orange", linestyle="--", label="of the mean graph over a period")
    if shaded or axes.get_legend_handles_labels()[0]:
        axes.legend(loc="best", fontsize=9)
    axes.set(xlabel="t, s" + (" (a run in memory)" if stages.followed else ""), ylabel="λ₂")
    axes.set_xlim(over[0][0], over[-1][0])
    axes.set_ylim(bottom=0)
    axes.margins(y=0.1)
    axes.grid(alpha=0.3)


def _draw(axes: Axes, graph: Graph, title: str, *, small: bool = False) -> None:
    at = places(graph)
    listens = {(i, j): a_ij for i, j, a_ij in graph.edges}
    many = graph.robots > 20
    size = 6 if many else 10 if small else 14
    for (i, j), a_ij in listens.items():
        both = (j, i) in listens
        if both and i > j:
            continue
        axes.annotate(
            "",
            xy=at[i],
            xytext=at[j],
            arrowprops={
                "arrowstyle": "-" if both else "-|>",
                "color": "0.45",
                "linewidth": 0.4 if many else 1.5,
                "shrinkA": size,
                "shrinkB": size,
            },
        )
        if a_ij != 1 or (both and listens[j, i] != 1):
            label = f"{a_ij:g}" if not both or listens[j, i] == a_ij else f"{a_ij:g} | {listens[j, i]:g}"
            axes.text((at[i][0] + at[j][0]) / 2, (at[i][1] + at[j][1]) / 2, label, ha="center", backgroundcolor="w")
    axes.scatter([x for x, _ in at], [y for _, y in at], s=size**2 * 3, color="tab:cyan", zorder=3)
    if graph.robots <= 60:
        for i, (x, y) in enumerate(at):
            axes.text(x, y, str(i), ha="center", va="center", fontsize=size, zorder=4)
    axes.set(xlim=(-0.12, 1.12), ylim=(1.12, -0.12), aspect="equal", title=title)
    axes.axis("off")
