"""What the checkers said of a cell's runs (`odourswarm sweep --check`): how many kept their promises, which were broken.

Rules: only of cells in which a run was checked; a run of a sweep without --check is neither kept nor broken. A promise that
a scenario's liar is meant to break does not count.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from deploy.sweep.rows import Row

HEADINGS = ("promises kept",)


@dataclass(frozen=True, slots=True)
class Kept:
    """The promises of one cell's runs."""

    checked: int
    kept: int
    broken: tuple[tuple[str, int], ...]  # (the first promise that a run broke, in how many runs), the commonest first


def kept_of(rows: Sequence[Row]) -> Kept | None:
    """The promises of `rows`; None when no run was checked."""
    checked = [row for row in rows if row.get("kept") is not None]
    if not checked:
        return None
    broken = Counter(str(row["broken"]) for row in checked if not row["kept"])
    in_order = sorted(broken.items(), key=lambda each: (-each[1], each[0]))
    return Kept(len(checked), sum(bool(row["kept"]) for row in checked), tuple(in_order))


def numbers(cell: Kept | None) -> dict[str, object]:
    """For `--json` and CSV."""
    return {
        "checked": cell.checked if cell else 0,
        "kept": cell and cell.kept,
        "broken": cell and " ".join(f"{name}:{count}" for name, count in cell.broken),
    }


def fields(cell: Kept | None) -> list[str]:
    """For a person, under HEADINGS."""
    if cell is None:
        return ["-"]
    broken = ", ".join(f"{name} {count}" for name, count in cell.broken)
    return [f"{cell.kept} of {cell.checked}" + (f" ({broken})" if broken else "")]
