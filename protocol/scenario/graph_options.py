"""What the topologies that are generated, and the schedules that switch among them, ask for.

Nothing of this is in the thesis: section 7.2 only names directed and switching topologies as open problems.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.scenario.table import Count, NonNegative, Positive, Table

OF_THE_RUN = -1  # the seed of the run


class GraphOptions(Table, frozen=True):
    """Parameters of `k-nearest`, `random`, `range-limited` and of schedules."""

    nearest: Count = 2  # k-nearest: to how many of the nearest, where the robots start, each one is linked
    mean_degree: NonNegative = 2.5  # random: neighbours per robot on the average; at least a tree, at most everyone
    seed: Annotated[int, Meta(ge=-1, le=2**63 - 1)] = OF_THE_RUN  # random: which graph; -1: by the seed of the run
    range: Positive = 30.0  # range-limited: how far a robot is heard, hand to hand, m
    period: NonNegative = 0.0  # a schedule begins anew after so many s; 0: its last stage stays
