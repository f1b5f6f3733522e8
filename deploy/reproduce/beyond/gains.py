"""Success and time of the algorithms against the gain of the corner noise, and each beside `plume-map`, plume by plume."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from deploy.reproduce.beyond.paired import Pair, compare
from deploy.reproduce.beyond.runs import get_rows
from deploy.reproduce.kinds import OURS, Options, Result, Row
from deploy.sweep.rows import Row as Run
from deploy.sweep.summary import CellSummary, summarise

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

US = "plume-map"
GAIN = "wind.gain"

Cells = Mapping[tuple[float, str], CellSummary]
Pairs = Mapping[tuple[float, str], Pair]


def beyond(options: Options) -> Result:
    """The picture and the numbers, from a sweep's result or from a few runs made now."""
    return result_of(get_rows(options))


def result_of(runs: Sequence[Run]) -> Result:
    """What the finished `runs` show."""
    gains = sorted({float(run[GAIN]) for run in runs})
    names = sorted({str(run["algorithm"]) for run in runs}, key=lambda name: (name != US, name))
    at = {gain: [run for run in runs if float(run[GAIN]) == gain] for gain in gains}
    groups = {(gain, name): [run for run in at[gain] if run["algorithm"] == name] for gain in gains for name in names}
    cells = {key: summarise(group, ())[0] for key, group in groups.items() if group}
    pairs = {
        (gain, rival): pair for gain, rival in groups if rival != US and (pair := compare(at[gain], US, rival)) is not None
    }
    rows = [_cell_row(gain, name, cell) for (gain, name), cell in cells.items()]
    rows += [_pair_row(gain, pair) for (gain, _), pair in pairs.items()]
    return Result(rows, {"": _figure(gains, names, cells, pairs)}, _numbers(cells, pairs))


def _cell_row(gain: float, name: str, cell: CellSummary) -> Row:
    low, high = cell.interval or (0.0, 1.0)
    middle = "" if cell.median_interval is None else f" ({cell.median_interval[0]:.0f}-{cell.median_interval[1]:.0f})"
    ours = (
        f"{100 * cell.share:.1f} % found ({100 * low:.0f}-{100 * high:.0f}), median {cell.median:.0f} s{middle}, "
        f"mean {cell.mean:.0f} s, {cell.runs} runs"
    )
    return Row(f"{name} at gain {gain:g}", "", ours, OURS)


def _pair_row(gain: float, pair: Pair) -> Row:
    ends = "" if pair.interval is None else f" ({pair.interval[0]:.0f} to {pair.interval[1]:.0f})"
    ours = (
        f"{pair.rival} takes {pair.saved:.0f} s{ends} longer in the mean; {pair.ours} is faster on {pair.faster} and slower "
        f"on {pair.slower} of {pair.plumes} plumes"
    )
    note = f"sign test p = {pair.sign:.2g}, Wilcoxon p = {pair.wilcoxon:.2g}"
    return Row(f"{pair.ours} and {pair.rival} on the same plumes at gain {gain:g}", "", ours, OURS, note)


def _numbers(cells: Cells, pairs: Pairs) -> dict[str, object]:
    return {
        "cells": [
            {
                "gain": gain, "algorithm": name, "runs": cell.runs, "found": cell.found, "found_share": cell.share,
                "found_share_95": cell.interval, "median_time_s": cell.median, "median_time_95_s": cell.median_interval,
                "mean_time_s": cell.mean, "min_pair_distance_m": cell.min_pair_distance,
            }
            for (gain, name), cell in cells.items()
        ],
        "pairs": [
            {
                "gain": gain, "ours": pair.ours, "rival": pair.rival, "plumes": pair.plumes, "saved_mean_s": pair.saved,
                "saved_mean_95_s": pair.interval, "faster": pair.faster, "slower": pair.slower, "sign_test_p": pair.sign,
                "wilcoxon_p": pair.wilcoxon,
            }
            for (gain, _), pair in pairs.items()
        ],
    }  # fmt: skip


def _figure(gains: Sequence[float], names: Sequence[str], cells: Cells, pairs: Pairs) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.5, 4.2), layout="constrained")
    success, time, saved = figure.subplots(1, 3)
    for n, name in enumerate(names):
        # Side by side, so that intervals do not hide each other.
        at = {gain: k + 0.09 * (n - 0.5 * (len(names) - 1)) for k, gain in enumerate(gains)}
        own = [(at[gain], cells[gain, name]) for gain in gains if (gain, name) in cells]
        percent = [(x, 100 * c.share, (100 * c.interval[0], 100 * c.interval[1]) if c.interval else None) for x, c in own]
        _line(success, name, n, percent)
        _line(time, name, n, [(x, c.median, c.median_interval) for x, c in own])
        _line(saved, name, n, [(at[g], pairs[g, name].saved, pairs[g, name].interval) for g in gains if (g, name) in pairs])
    success.set(ylabel="found, % (Wilson, 95 %)", ylim=(-3, 103))
    time.set(ylabel="median time, s (bootstrap, 95 %)", ylim=(0, None))
    saved.set(ylabel=f"time of a rival minus {US}'s\non the same plumes, mean, s")
    saved.axhline(0.0, color="0.5", lw=0.8)
    for axis in (success, time, saved):
        axis.set_xticks(range(len(gains)), [f"{gain:g}" for gain in gains])
        axis.set_xlabel("gain of the corner noise of the wind")
        axis.grid(alpha=0.3)
    success.legend(loc="lower left", fontsize=8)
    return figure


def _line(axis: Axes, name: str, n: int, points: Sequence[tuple[float, float, tuple[float, float] | None]]) -> None:
    """A line of values with their intervals, in the colour of the n-th algorithm."""
    if not points:
        return
    x, y, ends = zip(*points, strict=True)
    below = [value - end[0] if end else 0.0 for value, end in zip(y, ends, strict=True)]
    above = [end[1] - value if end else 0.0 for value, end in zip(y, ends, strict=True)]
    errors = [[max(0.0, each) for each in side] for side in (below, above)]
    axis.errorbar(x, y, errors, color=f"C{n}", marker="o", ms=4, lw=2.0 if name == US else 1.2, capsize=3, label=name)
