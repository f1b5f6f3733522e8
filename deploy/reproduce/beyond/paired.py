"""Two algorithms on the same plumes: what the difference of their times is, and whether it could be chance.

Rules: pure; a plume is named by what makes it, and only plumes that both algorithms met count; a run that did not find the
source counts with its max_time, as in `deploy.sweep.summary`. Plumes of one seed in different cases share draws, so that the
probabilities are somewhat optimistic.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from deploy.sweep.rows import Row
from deploy.sweep.summary import CONFIDENCE, RESAMPLES, Interval, time_of

PLUME = ("wind.gain", "case", "seed")  # what makes a plume, in one study


@dataclass(frozen=True, slots=True)
class Pair:
    """How much longer `rival` takes than `ours` on the same plumes."""

    ours: str
    rival: str
    plumes: int
    saved: float  # mean of the rival's time minus ours, s
    interval: Interval  # of the mean: percentile bootstrap, 95 %; None: fewer than two plumes
    faster: int  # plumes on which ours was faster
    slower: int
    sign: float  # probability of so uneven a split, or a more uneven one, if both were alike: sign test, two-sided
    wilcoxon: float  # the same by ranks: Wilcoxon's signed-rank test, two-sided


def compare(rows: Sequence[Row], ours: str, rival: str) -> Pair | None:
    """The pair of two algorithms over the plumes that both met; None when there is none."""
    from scipy.stats import binomtest

    mine, its = ({_plume(row): time_of(row) for row in rows if row["algorithm"] == name} for name in (ours, rival))
    # In the order of the plumes: the bootstrap draws by place.
    saved = [its[plume] - mine[plume] for plume in sorted(mine.keys() & its.keys())]
    if not saved:
        return None
    faster, slower = sum(each > 0.0 for each in saved), sum(each < 0.0 for each in saved)
    return Pair(
        ours=ours,
        rival=rival,
        plumes=len(saved),
        saved=sum(saved) / len(saved),
        interval=_bootstrap(saved),
        faster=faster,
        slower=slower,
        sign=float(binomtest(faster, faster + slower).pvalue) if faster + slower else 1.0,
        wilcoxon=_wilcoxon(saved),
    )


def _plume(row: Row) -> tuple[float, ...]:
    return tuple(float(row[name]) for name in PLUME)


def _wilcoxon(saved: Sequence[float]) -> float:
    from scipy.stats import wilcoxon

    return float(wilcoxon(saved).pvalue) if any(saved) else 1.0


def _bootstrap(saved: Sequence[float]) -> Interval:
    if len(saved) < 2:
        return None
    import numpy as np
    from scipy.stats import bootstrap

    rng = np.random.default_rng(0)
    values = (np.array(saved),)
    found = bootstrap(
        values, np.mean, n_resamples=RESAMPLES, confidence_level=CONFIDENCE, method="percentile", random_state=rng
    ).confidence_interval
    return float(found.low), float(found.high)
