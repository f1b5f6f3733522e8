"""What all tables of a scenario are made of: the record's base and the numbers with their bounds.

Rules: no NaN and no infinity is in any of these types, so that none gets into a scenario.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta, Struct

Positive = Annotated[float, Meta(gt=0, le=1e9)]
NonNegative = Annotated[float, Meta(ge=0, le=1e9)]
Real = Annotated[float, Meta(ge=-1e9, le=1e9)]
Fraction = Annotated[float, Meta(ge=0, le=1)]
OpenFraction = Annotated[float, Meta(gt=0, lt=1)]
Count = Annotated[int, Meta(ge=1, le=1000)]
Point = tuple[Real, Real]


class Table(Struct, frozen=True, forbid_unknown_fields=True):
    """Base of all tables."""
