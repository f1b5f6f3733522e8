"""A graph as an image file.

Rules: matplotlib without a display and without global state; it is loaded when the first image is drawn.
"""

from __future__ import annotations

from pathlib import Path

from deploy.cli.graph_layout import places
from protocol.topology.graph import Graph


def save_png(graph: Graph, title: str, file: Path) -> None:
    """Draw `graph` into `file`; an arrow points at the robot that listens.

    Raises: OSError when the file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6, 6), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    at = places(graph)
    listens = {(i, j): a_ij for i, j, a_ij in graph.edges}
    size = 14 if graph.robots <= 20 else 6
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
                "linewidth": 1.5 if graph.robots <= 20 else 0.4,
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
    figure.savefig(file, format="png", dpi=120)
