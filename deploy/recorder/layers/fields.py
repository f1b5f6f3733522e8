"""Wind as arrows and plume as filaments.

Positions are rounded to 1/16 m and radii to 1/20 m: a tenth of a filament, invisible, and half the size of
the file.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray
from rerun.chunk import Chunk

from deploy.recorder import palette
from deploy.recorder.chunks import pixels, temporal, timeless
from protocol.messages import Field
from protocol.scenario import Scenario

ARROWS = 11  # per axis, at most
FILAMENTS = 4000  # drawn per picture, at most; the codec allows 87,000
_PER_METRE, _PER_RADIUS = 16.0, 20.0


class FieldLayer:
    """Draws `Field` messages."""

    def __init__(self, scenario: Scenario) -> None:
        arena, wind = scenario.arena, scenario.wind
        self._nodes = wind.nodes
        self._step = max(1, math.ceil((wind.nodes - 1) / (ARROWS - 1)))
        xs = np.linspace(arena.x_min, arena.x_max, wind.nodes)[self._step // 2 :: self._step]
        ys = np.linspace(arena.y_min, arena.y_max, wind.nodes)[self._step // 2 :: self._step]
        self._origins = np.stack(np.meshgrid(xs, ys, indexing="ij"), axis=-1).reshape(-1, 2)
        between = float(min(xs[1] - xs[0], ys[1] - ys[0]))
        self._stretch = 0.6 * between / wind.speed  # m of arrow for 1 m/s

    def static(self) -> Iterator[Chunk]:
        """Where the arrows stand, and how filaments look."""
        yield from timeless(
            "arena/wind",
            rr.Arrows2D.from_fields(
                origins=self._origins, radii=pixels(1.1), colors=palette.WIND, draw_order=-30
            ),
        )
        yield from timeless("arena/plume", rr.Points2D.from_fields(colors=palette.PLUME, draw_order=-20))

    def rows(self, fields: Sequence[Field]) -> Iterator[Chunk]:
        """Wind and plume of `fields`."""
        size = self._nodes * self._nodes * 8
        windy = sorted((f for f in fields if len(f.wind) == size), key=lambda f: f.tick)
        if windy:
            wind = np.frombuffer(b"".join(f.wind for f in windy), dtype="<f4")
            wind = wind.reshape(len(windy), self._nodes, self._nodes, 2)[
                :, self._step // 2 :: self._step, self._step // 2 :: self._step
            ]
            arrows = np.round(wind.reshape(len(windy), -1, 2) * self._stretch * _PER_METRE) / _PER_METRE
            columns = rr.Arrows2D.columns(vectors=arrows.reshape(-1, 2)).partition(
                [arrows.shape[1]] * len(windy)
            )
            yield from temporal("arena/wind", *_times(windy), columns)
        smelly = sorted((f for f in fields if len(f.filaments) % 12 == 0), key=lambda f: f.tick)
        if smelly:
            pictures = [_picture(f.filaments) for f in smelly]
            together = np.concatenate(pictures)
            columns = rr.Points2D.columns(positions=together[:, :2], radii=together[:, 2])
            yield from temporal("arena/plume", *_times(smelly), columns.partition([len(p) for p in pictures]))


def _picture(filaments: bytes) -> NDArray[np.float32]:
    """x, y, radius of the filaments to draw, (M, 3); equal radii stand together, which packs well."""
    rows = np.frombuffer(filaments, dtype="<f4").reshape(-1, 3)
    if len(rows) > FILAMENTS:
        rows = rows[:: math.ceil(len(rows) / FILAMENTS)]
    rounded = np.rint(rows * np.float32(_PER_METRE)) / np.float32(_PER_METRE)
    rounded[:, 2] = np.maximum(np.rint(rows[:, 2] * np.float32(_PER_RADIUS)), 1.0) / np.float32(_PER_RADIUS)
    picture: NDArray[np.float32] = rounded[np.argsort(rounded[:, 2], kind="stable")].astype(
        np.float32, copy=False
    )
    return picture


def _times(fields: Sequence[Field]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    return np.array([f.t for f in fields], dtype=np.float64), np.array(
        [f.tick for f in fields], dtype=np.int64
    )
