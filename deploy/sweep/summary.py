"""What came out of a sweep, one row per cell.

The time is the one at which the source was reached. A run that did not find it counts with its max_time, as in the thesis
(section 4.4): in the median, the mean, the standard deviation and the bootstrap. Rules: the same rows give the same numbers,
in whatever order they come.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean, median, stdev

from deploy.sweep.declared import Declared, declared_of
from deploy.sweep.kept import Kept, kept_of
from deploy.sweep.rows import Row

CONFIDENCE = 0.95
RESAMPLES = 9999
Interval = tuple[float, float] | None


@dataclass(frozen=True, slots=True)
class CellSummary:
    """The runs of one cell."""

    values: Mapping[str, object]  # of the columns that vary
    runs: int
    found: int
    interval: Interval  # of the share that found the source: Wilson, 95 %
    median: float  # s
    median_interval: Interval  # percentile bootstrap, 95 %; None: fewer than two runs
    mean: float  # s
    std: float | None  # s, of the sample; None: fewer than two runs
    min_pair_distance: float | None  # m, the smallest of all runs
    first_detection: float | None  # s, the median over the runs that met the odour
    disagreement: float | None  # m, the median over the runs at whose end two robots had an estimate
    disagreement_interval: Interval  # percentile bootstrap, 95 %
    estimate_error: float | None  # m, the median over the runs; of a run the mean of the robots that have an estimate
    estimate_error_interval: Interval  # percentile bootstrap, 95 %
    declared: Declared | None = None  # what the swarm said; None: nothing
    kept: Kept | None = None  # what the checkers said; None: they were not asked

    @property
    def share(self) -> float:
        """Of the runs, those that found the source."""
        return self.found / self.runs


def time_of(row: Row) -> float:
    """When the source was reached, s; max_time when it was not."""
    if not row["found"]:
        return float(row["max_time"])
    reached = row.get("reached_at")  # a run that ends at the swarm's word goes on after it
    return float(row["time"] if reached is None else reached)


def summarise(rows: Sequence[Row], grid: Sequence[str]) -> list[CellSummary]:
    """One summary per cell, in the order of the rows.

    Args:
        grid: the columns that may vary; those that do tell the cells apart, with the label.
    """
    names = varying(rows, grid)
    groups: dict[tuple[object, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault(tuple(row.get(name) for name in names), []).append(row)
    return [_cell(dict(zip(names, values, strict=True)), group) for values, group in groups.items()]


def varying(rows: Sequence[Row], grid: Sequence[str]) -> list[str]:
    """The columns that tell the cells apart: of the grid's those that have more than one value.

    Where labels were given, the label comes first and stands for the values that go with it.
    """
    names = [name for name in grid if len({row.get(name) for row in rows}) > 1]
    if all(row["label"] == row["algorithm"] for row in rows):
        return names
    labels = {row["label"] for row in rows}
    return ["label", *(name for name in names if len({(row["label"], row.get(name)) for row in rows}) > len(labels))]


def _cell(values: dict[str, object], rows: list[Row]) -> CellSummary:
    # Sorted: the bootstrap draws by place.
    times = sorted(map(time_of, rows))
    nearest = [row["min_pair_distance"] for row in rows if row["min_pair_distance"] is not None]
    firsts = [row["first_detection"] for row in rows if row["first_detection"] is not None]
    found = sum(row["found"] for row in rows)
    apart = sorted(row["disagreement"] for row in rows if row.get("disagreement") is not None)
    errors = sorted(fmean(own) for row in rows if (own := [e for e in row.get("estimate_error") or () if e is not None]))
    return CellSummary(
        values=values,
        runs=len(rows),
        found=found,
        interval=_wilson(found, len(rows)),
        median=median(times),
        median_interval=_bootstrap(times),
        mean=fmean(times),
        std=stdev(times) if len(times) > 1 else None,
        min_pair_distance=min(nearest, default=None),
        first_detection=median(firsts) if firsts else None,
        disagreement=median(apart) if apart else None,
        disagreement_interval=_bootstrap(apart),
        estimate_error=median(errors) if errors else None,
        estimate_error_interval=_bootstrap(errors),
        declared=declared_of(rows),
        kept=kept_of(rows),
    )


def _wilson(found: int, runs: int) -> Interval:
    from scipy.stats import binomtest

    interval = binomtest(found, runs).proportion_ci(confidence_level=CONFIDENCE, method="wilson")
    return float(interval.low), float(interval.high)


def _bootstrap(times: list[float]) -> Interval:
    if len(times) < 2:
        return None
    import numpy as np
    from scipy.stats import bootstrap

    result = bootstrap(
        (np.array(times),),
        np.median,
        n_resamples=RESAMPLES,
        vectorized=True,
        confidence_level=CONFIDENCE,
        method="percentile",
        random_state=np.random.default_rng(0),
    )
    interval = result.confidence_interval
    return float(interval.low), float(interval.high)
