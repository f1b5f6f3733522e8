"""A summary as text: a table for the terminal, CSV, Markdown, and the objects of `--json`.

Rules: CSV and JSON have every digit and one number a field; a person reads rounded ones with their units above.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

from deploy.sweep import declared, kept
from deploy.sweep.summary import CellSummary, Interval

FORMATS = ("table", "csv", "markdown")
# An interval in brackets is one of 95 %; "nearest" is the smallest distance of two robots, "first" the first detection.
HEADINGS = ("runs", "found, %", "median, s", "mean, s", "std, s", "nearest, m", "first, s")


def headings(cells: Sequence[CellSummary]) -> tuple[str, ...]:
    """Of the numbers of `fields`: what the swarms declared only where one did, what the checkers said where they did."""
    said = declared.HEADINGS if _any_declared(cells) else ()
    return (*HEADINGS, *said, *(kept.HEADINGS if _any_checked(cells) else ()))


def objects(cells: Sequence[CellSummary]) -> list[dict[str, object]]:
    """Each cell as a flat object; an interval is two numbers, `_low` and `_high`."""
    with_declared, with_kept = _any_declared(cells), _any_checked(cells)
    return [
        {
            **cell.values,
            "runs": cell.runs,
            "found": cell.found,
            "found_share": cell.share,
            **_ends("found_share", cell.interval),
            "median_time": cell.median,
            **_ends("median_time", cell.median_interval),
            "mean_time": cell.mean,
            "std_time": cell.std,
            "min_pair_distance": cell.min_pair_distance,
            "first_detection": cell.first_detection,
            "disagreement": cell.disagreement,
            **_ends("disagreement", cell.disagreement_interval),
            "estimate_error": cell.estimate_error,
            **_ends("estimate_error", cell.estimate_error_interval),
            **(declared.numbers(cell.declared) if with_declared else {}),
            **(kept.numbers(cell.kept) if with_kept else {}),
        }
        for cell in cells
    ]


def as_csv(cells: Sequence[CellSummary]) -> str:
    """Comma-separated values with a heading."""
    rows = objects(cells)
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]) if rows else [], lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def as_markdown(cells: Sequence[CellSummary]) -> str:
    """A Markdown table."""
    names = list(cells[0].values) if cells else []
    numbers = headings(cells)
    heads = [*(f"`{name}`" if name != "label" else name for name in names), *numbers]
    lines = [heads, [*("---" for _ in names), *("---:" for _ in numbers)]]
    lines += [[text.replace("|", "\\|") for text in row] for row in table(cells)]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def fields(cell: CellSummary) -> list[str]:
    """A cell's values and numbers, rounded for a person."""
    return [
        *(_value(value) for value in cell.values.values()),
        str(cell.runs),
        f"{100 * cell.share:.0f}{_interval(cell.interval, 100)}",
        f"{cell.median:.0f}{_interval(cell.median_interval, 1)}",
        f"{cell.mean:.0f}",
        _number(cell.std, 0),
        _number(cell.min_pair_distance, 2),
        _number(cell.first_detection, 0),
    ]


def table(cells: Sequence[CellSummary]) -> list[list[str]]:
    """All cells under their values and `headings`."""
    rows = [fields(cell) for cell in cells]
    if _any_declared(cells):
        rows = [[*row, *declared.fields(cell.declared)] for row, cell in zip(rows, cells, strict=True)]
    if _any_checked(cells):
        rows = [[*row, *kept.fields(cell.kept)] for row, cell in zip(rows, cells, strict=True)]
    return rows


def _any_declared(cells: Sequence[CellSummary]) -> bool:
    return any(cell.declared is not None for cell in cells)


def _any_checked(cells: Sequence[CellSummary]) -> bool:
    return any(cell.kept is not None for cell in cells)


def _value(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"


def _interval(interval: Interval, scale: float) -> str:
    return "" if interval is None else f" ({scale * interval[0]:.0f}-{scale * interval[1]:.0f})"


def _ends(name: str, interval: Interval) -> dict[str, object]:
    low, high = interval or (None, None)
    return {f"{name}_low": low, f"{name}_high": high}
