"""The laws of chapter 3."""

from __future__ import annotations

from typing import Literal

from protocol.scenario.table import NonNegative, OpenFraction, Positive, Table


class Simple(Table, frozen=True):
    """The cooperative law (3.34) with (3.35), Table 3.2."""

    a: OpenFraction = 0.5
    delta: Positive = 0.2


class Repulsion(Table, frozen=True):
    """The potential (3.35), (3.36), Table 3.2."""

    kappa: Positive = 0.5
    d: Positive = 4.0  # m
    d0: Positive = 6.6  # m
    gap: NonNegative = 0.8  # the barrier lets no pair of robots closer, m; 0: (3.35) alone
    brake: Positive = 0.3  # how hard the barrier counts on each robot to brake, m/s^2
    keep: NonNegative = 0.65  # m: who senses the others brakes in time to stay so far away; 0: it does not (the guard)
    form: Literal["sum", "switch"] = "sum"  # added to (3.34), or instead of it within d0 as printed
