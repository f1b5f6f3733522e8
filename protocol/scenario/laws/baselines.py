"""Baselines without a decision."""

from __future__ import annotations

from protocol.scenario.table import NonNegative, Positive, Table


class Surge(Table, frozen=True):
    """Drive upwind; with casting when the plume is lost. Lengths go with the plume's width, 2 to 4 m."""

    speed: Positive = 0.8  # m/s
    margin: NonNegative = 3.0  # the middle of the group turns this far from the edge of the arena, m
    back: Positive = 40.0  # surge: way back downwind from the edge, m
    shift: NonNegative = 2.0  # surge: how much further to the side each return leads, m
    lost: Positive = 3.0  # surge-cast: odour not met on so long a way is lost, m
    cast: Positive = 4.0  # surge-cast: reach of the first crosswind leg, and what each further leg adds, m
    retreat: NonNegative = 1.0  # surge-cast: how far downwind each further leg lies, m


class Walk(Table, frozen=True):
    """A random walk of straight legs."""

    speed: Positive = 0.8  # m/s
    shortest: Positive = 10.0  # leg, s
    longest: Positive = 40.0
    margin: NonNegative = 3.0  # legs end this far from the edge of the arena, m
    gain: Positive = 2.0  # of the velocity error, 1/s
