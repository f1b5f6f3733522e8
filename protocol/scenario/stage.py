"""The stages of a schedule: which graph rules when.

Rules: a stage rules from its time on until the next one's; time is counted from the start of the run, or of the period
where the schedule repeats. World and robots ask the same function, so that they always agree.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence

from protocol.scenario.table import NonNegative, Table

Edge = tuple[int, int, float]  # (i, j, a_ij): robot i listens to robot j with weight a_ij
SLACK = 1e-9  # s: a tick's time is a product and may be a rounding short of the stage's


class Stage(Table, frozen=True):
    """One graph of a schedule."""

    at: NonNegative  # s
    name: str  # a topology, or the path of a graph file
    range: NonNegative = 0.0  # who is farther away is not heard, m; 0: no limit
    edges: tuple[Edge, ...] = ()  # filled in from `name`


class RowStage(Table, frozen=True):
    """What one robot knows of a stage: its own row."""

    at: float  # s
    row: tuple[tuple[int, float], ...]  # (j, a_ij): whom it listens to, if near enough where the stage has a range


def stage_at(starts: Sequence[float], period: float, t: float) -> int:
    """Number of the stage that rules at time `t`.

    Args:
        starts: when each stage begins, s, growing, the first at 0.
        period: after which they begin anew, s; 0: never.
        t: simulated time, s.
    """
    phase = t + SLACK
    if period > 0.0:
        phase %= period
    return max(0, bisect_right(starts, phase) - 1)


def label(stages: Sequence[Stage]) -> str:
    """The stages in a few words: "line > star@10"."""
    return " > ".join(
        stage.name + (f"<{stage.range:g}m" if stage.range else "") + (f"@{stage.at:g}" if stage.at else "")
        for stage in stages
    )
