"""Where the robots hold the source to be: a heat picture in the arena, of all together and, to be switched on, of each.

A cell is as opaque as the root of its probability; what is fainter than `FAINTEST` is left out, so that the picture shrinks
with the doubt. Pictures are PNG files, a tenth of the size of their pixels.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence

import numpy as np
import rerun as rr
from PIL import Image
from rerun.chunk import Chunk

from deploy.recorder import palette
from deploy.recorder.chunks import pixels, temporal, timeless
from deploy.recorder.decisions import Board
from deploy.recorder.maps import Grid, common, grid_of
from protocol.messages import BeliefMap
from protocol.scenario import Scenario

ALL, EACH, LEGEND = "arena/map/all", "arena/map/each", "arena/map/legend"
FAINTEST = 8  # of 255: a probability of a thousandth of the largest
OPACITY = 0.75  # of the most probable cell
PERIOD = 2.0  # s, as the robots tell their maps at the default decision period
BELOW = 3.0  # m, the legend below the arena's frame
WORDS = "where the robots hold the source to be: the redder, the likelier"


class MapLayer:
    """Draws `BeliefMap` messages."""

    def __init__(self, scenario: Scenario) -> None:
        self._board: Board[BeliefMap] = Board(scenario.robots, max(PERIOD, scenario.timing.decision))
        self._corner = (scenario.arena.x_min, scenario.arena.y_max)
        self._seen: set[int] = set()

    def rows(self, said: Sequence[BeliefMap], live: frozenset[int], *, last: bool = False) -> Iterator[Chunk]:
        """The pictures of the maps that are complete, or have waited long enough."""
        self._board.add(said)
        rows = self._board.rows(live, all_of_them=last)
        maps = [
            {i: grid for i, each in row.beliefs.items() if (grid := grid_of(each)) is not None} for row in rows
        ]
        if not any(maps):
            return
        if not self._seen:
            yield from self._legend()
        drawn = [(row.tick, row.t, grid) for row, grids in zip(rows, maps, strict=True) if (grid := common(grids))]
        yield from self._pictures(ALL, drawn, palette.MAP)
        for i in sorted({i for grids in maps for i in grids}):
            self._seen.add(i)
            own = [(row.tick, row.t, grids[i]) for row, grids in zip(rows, maps, strict=True) if i in grids]
            yield from self._pictures(f"{EACH}/robot_{i}", own, palette.robot_colour(i))

    def _pictures(self, entity: str, drawn: Sequence[tuple[int, float, Grid]], colour: int) -> Iterator[Chunk]:
        grids = [grid.cropped(FAINTEST) for _, _, grid in drawn]
        ticks = np.array([tick for tick, _, _ in drawn], dtype=np.int64)
        t = np.array([when for _, when, _ in drawn], dtype=np.float64)
        files = rr.EncodedImage.columns(
            blob=[png(grid, colour) for grid in grids],
            media_type=["image/png"] * len(grids),
            opacity=[OPACITY] * len(grids),  # below 1, or the viewer would draw black where a picture is transparent
            draw_order=[-25.0] * len(grids),
        )
        places = rr.Transform3D.columns(
            translation=[(grid.x, grid.y, 0.0) for grid in grids], scale=[(grid.cell, grid.cell, 1.0) for grid in grids]
        )
        yield from temporal(entity, t, ticks, files, places)

    def _legend(self) -> Iterator[Chunk]:
        """Said only when there are maps."""
        x, y = self._corner
        label = rr.Points2D(
            [(x, y + BELOW)], labels=[WORDS], show_labels=True, radii=pixels(3.0), colors=palette.MAP, draw_order=-24
        )
        yield from timeless(LEGEND, label)


def png(grid: Grid, colour: int) -> bytes:
    """The picture of a map: one colour, as opaque as the cell is likely."""
    rows, columns = grid.levels.shape
    picture = np.empty((rows, columns, 4), dtype=np.uint8)
    picture[..., :3] = [(colour >> shift) & 255 for shift in (24, 16, 8)]
    picture[..., 3] = grid.levels
    file = io.BytesIO()
    Image.fromarray(picture).save(file, "PNG")
    return file.getvalue()
