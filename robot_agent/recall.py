"""The best of what was smelt lately: x_l and x_g of (2.3), with a memory that ends.

Thesis (2.3): the position of the highest concentration so far. In a plume that is torn into filaments the highest
concentration so far is an accident of long ago: it stays where two filaments once lay over each other and holds the
decision (3.31) there. A smell counts only as long as a plume without smell is not yet called lost (`decision.recall`;
0: for ever, as printed). Ages are reckoned from the newest detection that one knows of, so that nothing is forgotten
for nothing.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple


class Smell(NamedTuple):
    """One detection."""

    concentration: float  # ppt
    at: float  # s
    x: float  # m
    y: float


class Recall:
    """One robot's own detections, the latest `horizon` seconds of them."""

    __slots__ = ("_horizon", "_smells")

    def __init__(self, horizon: float) -> None:
        """`horizon`: s; 0: only the best of all times is kept."""
        self._horizon = horizon
        self._smells: deque[Smell] = deque()  # falling concentration: what is older and weaker than another is no use

    def add(self, smell: Smell) -> None:
        """Take a detection that is newer than all before."""
        smells = self._smells
        if self._horizon == 0.0 and smells and smells[0].concentration >= smell.concentration:
            return
        while smells and smells[-1].concentration <= smell.concentration:
            smells.pop()
        smells.append(smell)

    def best(self, newest: float) -> Smell | None:
        """The strongest one that counts; `newest`: time of the newest detection that one knows of, s."""
        smells = self._smells
        if self._horizon:
            while smells and smells[0].at < newest - self._horizon:
                smells.popleft()
        return smells[0] if smells else None
