"""The algorithms that the thesis compares itself with."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from protocol.scenario.table import Fraction, NonNegative, OpenFraction, Positive, Table

Period = Annotated[float, Meta(gt=0, le=600)]


class Wui(Table, frozen=True):
    """Wind utilisation, WUI-45 and WUII [Jatmiko 2007], on top of the tables `pso` and `cpso`."""

    charged: bool = True  # the intermediate velocity is that of the charged swarm, or of the plain one; INFERRED
    sampling: Annotated[float, Meta(gt=0, le=600)] = 10.0  # s; INFERRED: the best of 10 and 30 s, see docs/algorithms.md
    angle: Annotated[float, Meta(gt=0, lt=180)] = 45.0  # half of the forbidden cone about downwind, deg (the name WUI-45)
    forbidden: Literal["stop", "turn"] = "turn"  # what a forbidden velocity becomes: 0, or turned to the edge; INFERRED


class PpsoIm(Table, frozen=True):
    """Probability PSO with information-sharing mechanism [Lu & Han 2011]; constructed from the abstract, all INFERRED."""

    probability: Fraction = 0.1  # P: the PSO centre (2.4); otherwise a draw from the Gaussian of all best places
    stretch: NonNegative = 5.0  # the Gaussian's standard deviations are so many times those of the best places
    floor: Positive = 5.0  # standard deviation that it has at least, along every axis, m
    sampling: Period = 50.0  # from one position p_i(k) to the next, s
    recall: NonNegative = 60.0  # the best places are those of the latest so many seconds; 0: of all


class Lpso(Table, frozen=True):
    """Learning PSO [Lu & Luo 2011]; constructed from the abstract, all INFERRED."""

    cell: Annotated[float, Meta(ge=0.5, le=20)] = 2.0  # width of a cell of the map, m
    report: Period = 2.0  # from one report of a robot to the next, s
    width: Positive = 1.5  # half width of what an odour's way may have missed, m, at once
    spread: NonNegative = 0.3  # what its variance grows by, m/sqrt(s) of lag
    hit: OpenFraction = 0.3  # probability of smelling a source whose odour should be here
    false: OpenFraction = 0.03  # of smelling without
    memory: Positive = 200.0  # what a report counts fades with this time, s
    choice: Literal["mean", "best", "draw"] = "mean"  # the new position: the map's mean, its maximum, or a draw from it
    sampling: Period = 5.0  # from one new position to the next, s


class Ccs(Table, frozen=True):
    """A reading of the cooperative control system [Lu & Han 2011], of which nothing could be read; all INFERRED."""

    neighbours: Annotated[int, Meta(ge=0, le=1000)] = 2  # L: how many of the nearest neighbours (2.7) takes
    radius: NonNegative = 1.0  # of the formation about the planned position, m: no more than what counts as found
