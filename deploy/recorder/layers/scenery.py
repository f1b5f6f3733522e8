"""What never moves: the arena's frame and scale, the source and the circle in which it counts as found."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import rerun as rr
from rerun.chunk import Chunk

from deploy.recorder import palette
from deploy.recorder.chunks import pixels, strips, timeless
from protocol.scenario import Scenario
from protocol.scenario.sections import Arena


def scenery(scenario: Scenario) -> Iterator[Chunk]:
    """All of it."""
    arena, source = scenario.arena, scenario.source
    x, y = (arena.x_min, arena.x_max), (arena.y_min, arena.y_max)
    frame = np.array([[(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1]), (x[0], y[0])]])
    yield from timeless(
        "arena/frame",
        rr.LineStrips2D(strips(frame), radii=pixels(0.75), colors=palette.FRAME, draw_order=-40),
    )
    yield from _scale(arena)
    yield from timeless(
        "source",
        rr.Points2D(
            [(source.x, source.y)], radii=pixels(3.5), colors=palette.SOURCE, labels=["source"], draw_order=60
        ),
        rr.Ellipses2D(
            centers=[(source.x, source.y)],
            half_sizes=[(source.radius, source.radius)],
            line_radii=pixels(1.0),
            colors=palette.SOURCE,
            draw_order=59,
        ),
    )


def _scale(arena: Arena) -> Iterator[Chunk]:
    """Grid lines at round coordinates, with their values along the upper and the left edge, m."""
    step = round_step(max(arena.x_max - arena.x_min, arena.y_max - arena.y_min))
    xs, ys = ticks(arena.x_min, arena.x_max, step), ticks(arena.y_min, arena.y_max, step)
    lines = [((x, arena.y_min), (x, arena.y_max)) for x in xs] + [
        ((arena.x_min, y), (arena.x_max, y)) for y in ys
    ]
    yield from timeless(
        "arena/grid",
        rr.LineStrips2D(strips(np.array(lines)), radii=pixels(0.4), colors=palette.GRID, draw_order=-50),
    )
    away = 0.12 * step
    places = [(x, arena.y_min - away) for x in xs] + [(arena.x_min - away, y) for y in ys]
    yield from timeless(
        "arena/scale",
        rr.Points2D(
            places,
            labels=[f"{v:g}" for v in (*xs, *ys)],
            show_labels=True,
            radii=pixels(0.5),
            colors=palette.SCALE,
            draw_order=-45,
        ),
    )


def round_step(extent: float) -> float:
    """1, 2 or 5 times a power of ten, so that `extent` has about five steps."""
    rough = extent / 5.0
    power = 10.0 ** math.floor(math.log10(rough))
    return float(next(power * f for f in (1.0, 2.0, 5.0, 10.0) if power * f >= 0.999 * rough))


def ticks(low: float, high: float, step: float) -> list[float]:
    """Multiples of `step` in [low, high]."""
    first = math.ceil(low / step - 1e-9)
    last = math.floor(high / step + 1e-9)
    return [k * step + 0.0 for k in range(first, last + 1)]
