"""The robots' maps of the source as arrays, each by itself and all together.

Rules: pure; a map that cannot be read is left out, it never raises. The common map is the mean of the robots' probabilities:
robots that know the same events hold the same map, and then it is that one.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from protocol.messages import BeliefMap

MOST_CELLS = 1 << 18  # of one map
FULL = 255.0  # the level of the most probable cell

Levels = NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class Grid:
    """How probable the source is in each cell: 255 sqrt(p / p_max), (rows, columns), rows towards +y."""

    x: float  # lower corner, m
    y: float
    cell: float  # m
    levels: Levels

    def cropped(self, faintest: int) -> Grid:
        """The part that holds all cells of at least `faintest`."""
        rows, columns = np.nonzero(self.levels >= faintest)
        if rows.size == 0:
            return Grid(self.x, self.y, self.cell, np.zeros((1, 1), dtype=np.uint8))
        r, c = int(rows.min()), int(columns.min())
        part = self.levels[r : int(rows.max()) + 1, c : int(columns.max()) + 1]
        return Grid(self.x + c * self.cell, self.y + r * self.cell, self.cell, part)


def grid_of(said: BeliefMap) -> Grid | None:
    """The map in a message; None when it is none."""
    unpacker = zlib.decompressobj()
    try:
        levels = unpacker.decompress(said.levels, MOST_CELLS)
    except zlib.error:
        return None
    rows = said.rows
    if unpacker.unconsumed_tail or rows <= 0 or not levels or len(levels) % rows or not said.cell > 0.0:
        return None
    return Grid(said.x, said.y, said.cell, np.frombuffer(levels, dtype=np.uint8).reshape(rows, -1))


def common(grids: Mapping[int, Grid]) -> Grid | None:
    """The mean of the maps, by robot, that lie as the first one does."""
    if not grids:
        return None
    first = grids[min(grids)]
    alike = [g for g in grids.values() if _lies(g) == _lies(first)]
    total = np.zeros(first.levels.shape)
    for grid in alike:
        p = np.square(grid.levels / FULL)
        total += p / max(float(p.sum()), 1e-300)
    levels = np.rint(FULL * np.sqrt(total / max(float(total.max()), 1e-300))).astype(np.uint8)
    return Grid(first.x, first.y, first.cell, levels)


def _lies(grid: Grid) -> tuple[float, float, float, tuple[int, ...]]:
    return grid.x, grid.y, grid.cell, grid.levels.shape
