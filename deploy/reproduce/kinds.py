"""What a reproduction is made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Verdict = str  # "agrees" | "differs" | "ours" (the thesis says nothing)
AGREES, DIFFERS, OURS = "agrees", "differs", "ours"


@dataclass(frozen=True, slots=True)
class Row:
    """One quantity: what the thesis says, what we measured, and what to make of it."""

    quantity: str
    thesis: str  # in its own words or numbers, with the place; "" when it says nothing
    ours: str  # with its unit
    verdict: Verdict
    note: str = ""  # why it differs, as far as it is known


@dataclass(slots=True)
class Result:
    """What a reproduction gives."""

    rows: list[Row] = field(default_factory=list)
    figures: dict[str, Figure] = field(default_factory=dict)  # the end of the file's name -> picture; "" for the only one
    numbers: dict[str, object] = field(default_factory=dict)  # further figures for the JSON file


@dataclass(frozen=True, slots=True)
class Options:
    """What the person at the terminal may choose."""

    bus: str = "zenoh"  # for reproductions that run the swarm: zenoh, a process each, or memory
    seed: int = 0
    seeds: int | None = None  # for those that sum up a sweep: make so many runs of each kind now
    result: Path | None = None  # and the sweep's result, when it is not where a sweep puts it


@dataclass(frozen=True, slots=True)
class Reproduction:
    """A worked example of the thesis."""

    name: str  # as it is asked for, e.g. "fig-4.1"
    title: str
    place: str  # where it stands in the thesis
    make: Callable[[Options], Result]
    swarm: bool = False  # whether it runs the swarm, so that --bus matters
