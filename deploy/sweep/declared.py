"""What a cell's runs declared: how often, how soon after the source was reached, how far off, how often falsely.

Rules: only of cells in which a swarm declared something (`declaration.stop` = "declared"); of the declarations that were
made the delay and the error are medians. A run in which nobody came to the source has no delay.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from deploy.sweep.rows import Row

SOON = 60.0  # s after the source was reached
HEADINGS = ("declared, %", f"within {SOON:g} s, %", "delay, s", "off, m", "false, %")


@dataclass(frozen=True, slots=True)
class Declared:
    """The declarations of one cell."""

    runs: int
    declared: int
    soon: int  # at most SOON seconds after a robot reached the source, or before that
    delay: float | None  # from reaching to declaring, median, s
    error: float | None  # median, m
    false: int  # further than 2 m off, or without a source


def declared_of(rows: Sequence[Row]) -> Declared | None:
    """The declarations of `rows`; None when none was made."""
    made = [row for row in rows if row.get("declared")]
    if not made:
        return None
    delays = [row["declaration_delay"] for row in made if row["declaration_delay"] is not None]
    errors = [row["declaration_error"] for row in made if row["declaration_error"] is not None]
    return Declared(
        runs=len(rows),
        declared=len(made),
        soon=sum(delay <= SOON for delay in delays),
        delay=median(delays) if delays else None,
        error=median(errors) if errors else None,
        false=sum(bool(row["false_declaration"]) for row in made),
    )


def numbers(cell: Declared | None) -> dict[str, object]:
    """For `--json` and CSV."""
    return {
        "declared": cell and cell.declared,
        "declared_soon": cell and cell.soon,
        "declaration_delay": cell and cell.delay,
        "declaration_error": cell and cell.error,
        "false_declarations": cell and cell.false,
    }


def fields(cell: Declared | None) -> list[str]:
    """For a person, under HEADINGS."""
    if cell is None:
        return ["-"] * len(HEADINGS)
    delay = "-" if cell.delay is None else f"{cell.delay:.0f}"
    error = "-" if cell.error is None else f"{cell.error:.2f}"
    share = 100.0 / cell.runs
    return [f"{share * cell.declared:.0f}", f"{share * cell.soon:.0f}", delay, error, f"{share * cell.false:.1f}"]
