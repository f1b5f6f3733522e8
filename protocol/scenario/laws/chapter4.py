"""The laws of chapter 4."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.scenario.table import OpenFraction, Positive, Table


class Cfpso(Table, frozen=True):
    """The PSO-based law (4.12), Table 4.5."""

    omega: Annotated[float, Meta(lt=1, ge=-100)] = -0.5
    alpha: Positive = 8.0
    a: OpenFraction = 0.5
    gamma: Annotated[float, Meta(gt=0, le=1)] = 0.5
    beta: Positive = 0.01
    repulsion: bool = True  # (3.35) added; the thesis has no collision avoidance here
