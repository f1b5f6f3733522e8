"""The communication graph between the robots as they move: links that are heard, silent or broken, and how
many.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import rerun as rr
from numpy.typing import NDArray
from rerun.chunk import Chunk

from deploy.recorder import palette
from deploy.recorder.chunks import colours, pixels, strips, temporal, timeless
from deploy.recorder.links import BROKEN, CLOSED, HEARD, SILENT, LinkWatch
from deploy.recorder.track import Track
from protocol.scenario import Scenario

LINKS = {
    "links/heard": (HEARD, palette.HEARD, 0.7),
    "links/silent": (SILENT, palette.SILENT, 0.7),
    "links/broken": (BROKEN, palette.BROKEN, 0.9),
}
SWARM = "plots/swarm"
PICTURES = 40  # links drawn per state of the robots, on the average
BARB = 0.7  # size of the arrow head on a one-way link, m


class GraphLayer:
    """Draws the links at the places of `Truth`, in the state that the robots' beliefs tell."""

    def __init__(self, scenario: Scenario, watch: LinkWatch) -> None:
        self._watch = watch
        self._pairs = watch.pairs
        self._one_way = watch.one_way
        self._stride = max(1, math.ceil(len(self._pairs) / PICTURES))
        self._rows = 0
        self._showing: set[str] = set()  # entities whose last row holds a line

    def static(self) -> Iterator[Chunk]:
        """How links look."""
        for entity, (_, colour, radius) in LINKS.items():
            style = rr.LineStrips2D.from_fields(radii=pixels(radius), colors=colour, draw_order=5)
            yield from timeless(entity, style)
        style = rr.LineStrips2D.from_fields(radii=pixels(0.9), colors=palette.UNDECLARED, draw_order=6)
        yield from timeless("links/undeclared", style)
        if len(self._one_way):
            style = rr.LineStrips2D.from_fields(radii=pixels(0.7), colors=palette.HEARD, draw_order=6)
            yield from timeless("links/direction", style)
        names = ["robots alive", "links declared", "links up", "links heard"]
        shown = [palette.ALIVE, palette.FRAME, palette.UP, palette.HEARD]
        yield from timeless(
            SWARM, rr.SeriesLines(names=names, colors=colours(shown), widths=[2.5, 1.0, 1.5, 1.5])
        )

    def rows(self, track: Track) -> Iterator[Chunk]:
        """Links at the states of `track`, or at every few of them when there are many links."""
        chosen = track[slice(-self._rows % self._stride, None, self._stride)]
        self._rows += len(track)
        if len(chosen) == 0:
            return
        kinds = np.empty((len(chosen), len(self._pairs)), dtype=np.int8)
        stray: list[NDArray[np.intp]] = []
        for row, (t, alive, points) in enumerate(zip(chosen.t.tolist(), chosen.alive, chosen.points, strict=True)):
            kinds[row] = self._watch.at(t, alive, points)
            stray.append(self._watch.undeclared)
        ends = chosen.points[:, self._pairs]  # (K, E, 2, 2)
        for entity, (kind, _, _) in LINKS.items():
            yield from self._lines(entity, chosen, ends, kinds == kind)
        if len(self._one_way):
            yield from self._heads(chosen, kinds)
        yield from self._strays(chosen, stray)
        counts = np.column_stack(
            (
                chosen.alive.sum(axis=1),
                (kinds != CLOSED).sum(axis=1),
                (kinds < BROKEN).sum(axis=1),
                (kinds == HEARD).sum(axis=1),
            )
        )
        yield from temporal(
            SWARM, chosen.t, chosen.ticks, rr.Scalars.columns(scalars=counts.astype(np.float64))
        )

    def _lines(
        self, entity: str, track: Track, lines: NDArray[np.float64], mask: NDArray[np.bool_]
    ) -> Iterator[Chunk]:
        """Of `lines`, (K, E, P, 2), those in `mask`, (K, E)."""
        yield from self._show(entity, track, lines[mask], mask.sum(axis=1))

    def _heads(self, track: Track, kinds: NDArray[np.int8]) -> Iterator[Chunk]:
        """An arrow head in the middle of every one-way link that is up, pointing at the listener."""
        listener, speaker, place = self._one_way.T
        a, b = track.points[:, speaker], track.points[:, listener]
        along = b - a
        along /= np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-9)
        across = along[..., ::-1] * np.array((-1.0, 1.0))
        tip = 0.5 * (a + b) + 0.5 * BARB * along
        heads = np.stack(
            (tip + BARB * (0.6 * across - along), tip, tip - BARB * (0.6 * across + along)), axis=2
        )
        yield from self._lines("links/direction", track, heads, kinds[:, place] < BROKEN)

    def _strays(self, track: Track, stray: list[NDArray[np.intp]]) -> Iterator[Chunk]:
        lines = np.concatenate([track.points[row, pairs] for row, pairs in enumerate(stray)])
        yield from self._show("links/undeclared", track, lines, np.array([len(pairs) for pairs in stray]))

    def _show(
        self, entity: str, track: Track, lines: NDArray[np.float64], each: NDArray[np.intp]
    ) -> Iterator[Chunk]:
        """`each` many `lines`, (S, P, 2), per row; nothing where nothing was and nothing is."""
        if not len(lines) and entity not in self._showing:
            return
        (self._showing.add if each[-1] else self._showing.discard)(entity)
        yield from temporal(
            entity, track.t, track.ticks, rr.LineStrips2D.columns(strips=strips(lines)).partition(each)
        )
