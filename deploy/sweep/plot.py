"""What came out of a study, as a picture: a column for each quantity that it varies, a row for each measure.

Success has Wilson's intervals, all else is a median with a bootstrap interval, 95 % both; a run that did not find the source
counts with its max_time. Rules: matplotlib without a display and without global state; the same rows give the same picture.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from deploy.sweep.axes import places_of
from deploy.sweep.rows import Row
from deploy.sweep.spec import PLOT
from deploy.sweep.summary import CellSummary, Interval, summarise, varying

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Measure = tuple[str, Callable[[CellSummary], tuple[float | None, Interval]], float]
MEASURES: tuple[Measure, ...] = (  # name, value and interval, factor
    ("found, %", lambda cell: (cell.share, cell.interval), 100.0),
    ("time, s", lambda cell: (cell.median, cell.median_interval), 1.0),
    ("disagreement, m", lambda cell: (cell.disagreement, cell.disagreement_interval), 1.0),
    ("estimate error, m", lambda cell: (cell.estimate_error, cell.estimate_error_interval), 1.0),
)
MARKS = "osD^vP*X"
APART = 0.012  # of the axis: lines stand so far beside each other that their intervals can be told apart
NEAR = 0.1  # m: up to here a logarithmic scale is linear
FAR = 30.0  # so many times that is far
MOST_TICKS = 6
CLOSE = 0.03  # of the axis


@dataclass(frozen=True, slots=True)
class Point:
    """A cell on a line."""

    at: float
    label: str
    cell: CellSummary


Lines = dict[str, list[Point]]  # by the line's name, from left to right


def lines_of(rows: Sequence[Row], grid: Sequence[str]) -> dict[str, Lines]:
    """The lines of each axis: one for each choice of the grid, that is for each algorithm in most studies."""
    drawn = [row for row in rows if places_of(row)]
    names = [name for name in varying(drawn, grid) if name != "label"] if drawn else []
    groups: dict[tuple[str, str, float, str], list[Row]] = {}
    for row in drawn:
        line = ", ".join(str(row.get(name)) for name in names) or str(row["algorithm"])
        for axis, at in places_of(row).items():
            groups.setdefault((axis, line, at, str(row["label"])), []).append(row)
    axes: dict[str, Lines] = {}
    for (axis, line, at, label), group in groups.items():
        point = Point(at, label, summarise(group, ())[0])
        axes.setdefault(axis, {}).setdefault(line, []).append(point)
    for lines in axes.values():
        for points in lines.values():
            points.sort(key=lambda point: (point.at, point.label))
    return axes


def no_axis(file: Path | str) -> str:
    """The sentence for a study that says nothing about a picture."""
    return f"{file}: no cell says where it stands in a picture; write for example {PLOT} under a [[cells]]."


def draw(rows: Sequence[Row], grid: Sequence[str], title: str, file: Path) -> None:
    """Draw the rows into `file`, whose ending says the format.

    Args:
        grid: the columns that the study varies.
    Raises: OSError when the file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    axes = lines_of(rows, grid)
    columns = len(axes)
    figure = Figure(figsize=(max(2.3 * columns, 8.0), 8.2), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(len(MEASURES), columns, squeeze=False, sharex="col", sharey="row")
    for column, (axis, lines) in enumerate(axes.items()):
        for panel, measure in zip(panels[:, column], MEASURES, strict=True):
            _panel(panel, lines, measure)
        panels[-1, column].set_xlabel(axis)
        _ticks(panels[-1, column], lines)
        if columns == 1:
            _names(panels[0, 0], lines)
    for panel, (name, *_) in zip(panels[:, 0], MEASURES, strict=True):
        panel.set_ylabel(name)
    for row, (name, *_) in zip(panels, MEASURES, strict=True):
        _scale(list(row), name)
    handles, names = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=len(names), frameon=False)
    counts = sorted({point.cell.runs for lines in axes.values() for points in lines.values() for point in points})
    runs = f"{counts[0]} to {counts[-1]}" if counts[0] != counts[-1] else str(counts[0])
    figure.suptitle(f"{title + ': ' if title else ''}runs a point: {runs}; intervals: 95 %", fontsize="medium")
    figure.savefig(file, dpi=85)


def _panel(panel: Axes, lines: Lines, measure: Measure) -> None:
    """One measure of one axis."""
    _, value_of, factor = measure
    places = [point.at for points in lines.values() for point in points]
    step = APART * ((max(places) - min(places)) or 1.0)
    for n, (line, points) in enumerate(lines.items()):
        measured = [(point.at, *value_of(point.cell)) for point in points]
        known = [(at, value, interval) for at, value, interval in measured if value is not None]
        x = [at + (n - (len(lines) - 1) / 2) * step for at, _, _ in known]
        y = [factor * value for _, value, _ in known]
        ends = [interval or (value, value) for _, value, interval in known]
        below = [max(at - factor * low, 0.0) for at, (low, _) in zip(y, ends, strict=True)]
        above = [max(factor * high - at, 0.0) for at, (_, high) in zip(y, ends, strict=True)]
        # Where cells share a place a line from one to the next would say nothing.
        mark = MARKS[n % len(MARKS)] + ("-" if len({point.at for point in points}) == len(points) else "")
        panel.errorbar(x, y, yerr=(below, above), fmt=mark, ms=4, lw=0.9, elinewidth=0.9, capsize=2, label=line)
    panel.grid(alpha=0.3)


def _scale(panels: Sequence[Axes], name: str) -> None:
    """The scale that a row of panels shares. Distances of very different sizes are drawn on a logarithmic one, which is
    linear near 0: robots may agree to the last bit."""
    highest = max((panel.dataLim.y1 for panel in panels if panel.dataLim.y1 > 0.0), default=1.0)
    if name.endswith("%"):
        panels[0].set_ylim(-4.0, 104.0)
    elif name.endswith(", m") and highest > FAR * NEAR:
        panels[0].set_yscale("symlog", linthresh=NEAR)
        panels[0].set_ylim(-0.1 * NEAR, 2.0 * highest)
    else:
        panels[0].set_ylim(0.0, 1.1 * highest)


def _ticks(panel: Axes, lines: Lines) -> None:
    """A few whole numbers are all there."""
    places = sorted({point.at for points in lines.values() for point in points})
    if len(places) <= MOST_TICKS and all(place.is_integer() for place in places):
        panel.set_xticks(places)


def _names(panel: Axes, lines: Lines) -> None:
    """The cells' names above their places; of places that nearly touch, in one stack."""
    points = sorted((point.at, point.label) for points in lines.values() for point in points)
    room = CLOSE * (points[-1][0] - points[0][0])
    stacks: list[tuple[float, list[str]]] = []
    for at, label in points:
        if not stacks or at - stacks[-1][0] > room:
            stacks.append((at, []))
        if label not in stacks[-1][1]:
            stacks[-1][1].append(label)
    top = panel.secondary_xaxis("top")
    top.set_xticks([at for at, _ in stacks], ["\n".join(names) for _, names in stacks], rotation=90, fontsize=7)
