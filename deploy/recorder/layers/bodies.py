"""The robots as they are: body, heading, trail, and the plots of what they measure and do."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import rerun as rr
from numpy.typing import NDArray
from rerun.chunk import Chunk

from deploy.recorder import palette
from deploy.recorder.chunks import colours, pixels, strips, temporal, timeless
from deploy.recorder.track import NU, OMEGA, PPT, TAU_LEFT, TAU_RIGHT, THETA, Track
from protocol.scenario import Scenario

ARROW = 3.2  # length of a heading arrow, m
TRAIL_STEP = 0.5  # between two points of a trail, simulated s

PLOTS = {
    "plots/concentration": PPT,
    "plots/speed": NU,
    "plots/turn_rate": OMEGA,
    "plots/torque/left": TAU_LEFT,
    "plots/torque/right": TAU_RIGHT,
}
THRESHOLD = "plots/concentration/threshold"


def robot_label(i: int) -> str:
    """How robot `i` is called wherever it is shown."""
    return f"robot {i}"


def series(entity: str, n: int) -> Iterator[Chunk]:
    """Style of a plot with one line per robot."""
    names = [robot_label(i) for i in range(n)]
    lines = rr.SeriesLines(
        names=names, colors=colours([palette.robot_colour(i) for i in range(n)]), widths=[1.5] * n
    )
    yield from timeless(entity, lines)


class BodyLayer:
    """Draws `Truth` messages."""

    def __init__(self, scenario: Scenario) -> None:
        self._n = n = scenario.robots
        self._threshold = scenario.decision.threshold
        self._body = max(0.5 * scenario.body.axle, 0.05)
        self._colours = colours([palette.robot_colour(i) for i in range(n)])
        self._last_point: NDArray[np.float64] | None = None
        self._next_trail = -np.inf

    def static(self) -> Iterator[Chunk]:
        """How robots and their plots look."""
        n = self._n
        labels = [str(i) for i in range(n)]
        yield from timeless(
            "robots/body",
            rr.Points2D.from_fields(radii=pixels(5.0), labels=labels, show_labels=True, draw_order=50),
        )
        yield from timeless("robots/heading", rr.Arrows2D.from_fields(radii=pixels(1.25), draw_order=48))
        yield from timeless(
            "robots/trail",
            rr.LineStrips2D.from_fields(radii=pixels(0.8), colors=self._colours, draw_order=10),
        )
        for entity in PLOTS:
            yield from series(entity, n)
        style = rr.SeriesLines(names="detection threshold", colors=palette.THRESHOLD, widths=1.0)
        yield from timeless(THRESHOLD, style)

    def rows(self, track: Track) -> Iterator[Chunk]:
        """Bodies, headings, trails and plots of `track`."""
        if len(track) == 0:
            return
        k, n = len(track), self._n
        shown = np.where(track.alive, self._colours, np.uint32(palette.DEAD)).reshape(-1)
        points = track.points.reshape(-1, 2)
        theta = track.robots[:, :, THETA].reshape(-1)
        arrows = ARROW * np.column_stack((np.cos(theta), np.sin(theta)))
        each = [n] * k
        yield from temporal(
            "robots/body",
            track.t,
            track.ticks,
            rr.Points2D.columns(positions=points, colors=shown).partition(each),
        )
        yield from temporal(
            "robots/heading",
            track.t,
            track.ticks,
            rr.Arrows2D.columns(origins=points, vectors=arrows, colors=shown).partition(each),
        )
        yield from self._trail(track)
        # A dead robot says nothing: its lines end.
        silent = ~track.alive
        for entity, column in PLOTS.items():
            values = np.where(silent, np.nan, track.robots[:, :, column])
            yield from temporal(entity, track.t, track.ticks, rr.Scalars.columns(scalars=values))
        ends = slice(None, None, max(1, k - 1))
        level = np.full(len(track.t[ends]), self._threshold)
        yield from temporal(THRESHOLD, track.t[ends], track.ticks[ends], rr.Scalars.columns(scalars=level))

    def _trail(self, track: Track) -> Iterator[Chunk]:
        """A short strip per robot from where it was to where it is; the view shows all of the past."""
        rows = []
        for row, t in enumerate(track.t.tolist()):
            if t >= self._next_trail - 1e-9:
                rows.append(row)
                self._next_trail = t + TRAIL_STEP
        if not rows:
            return
        points = track.points[rows]
        first = points[:1] if self._last_point is None else self._last_point[None]
        before = np.concatenate((first, points[:-1]))
        self._last_point = points[-1]
        segments = np.stack((before, points), axis=2).reshape(-1, 2, 2)
        yield from temporal(
            "robots/trail",
            track.t[rows],
            track.ticks[rows],
            rr.LineStrips2D.columns(strips=strips(segments)).partition([self._n] * len(rows)),
        )
