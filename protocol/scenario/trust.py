"""How far a robot believes its neighbours: what no body, no clock and no sensor could have produced is not used.

None of it is from the thesis, which trusts everybody. The bounds are wide: in runs without faults nothing comes near them.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.scenario.table import NonNegative, Positive, Table


class Trust(Table, frozen=True):
    """Bounds on what a neighbour can claim (robot_agent.validation)."""

    check: bool = True  # False: everything is believed
    speed: Annotated[float, Meta(ge=1, le=100)] = 1.5  # how many times as fast as its body allows a hand may seem
    slack: Positive = 5.0  # m: and how much farther from its last place one may be; odometry with 1 m noise stays within
    margin: NonNegative = 100.0  # a robot this far outside the arena is not believed, m
    decided_margin: NonNegative = 60.0  # nor a fusion state or decision this far outside, m
    skew: NonNegative = 5.0  # times and ticks may be this far ahead of the own clock, s: honest clocks differ
    concentration: Positive = 1e6  # no sensor measures more, ppt
    readmit: Annotated[int, Meta(ge=1, le=10000)] = 10  # so many possible states in a row, and it is heard again
