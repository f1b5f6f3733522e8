"""Numbers as Rerun chunks: one entity, many rows, no loop over values.

Rules: every row has both times, `sim_time` in simulated seconds and `tick`; a chunk without rows is no chunk.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pyarrow as pa
import rerun as rr
from numpy.typing import NDArray
from rerun.chunk import Chunk

SIM_TIME, TICK = "sim_time", "tick"

_STRIP = rr.components.LineStrip2D.arrow_type()


def temporal(
    entity: str, t: NDArray[np.float64], ticks: NDArray[np.int64], *columns: rr.ComponentColumnList
) -> Iterator[Chunk]:
    """Rows of `entity` at times `t`, (K,), s, and `ticks`, (K,); every column has K rows."""
    if len(t) == 0:
        return
    times = np.rint(t * 1e9).astype("timedelta64[ns]")
    indexes = [rr.TimeColumn(SIM_TIME, duration=times), rr.TimeColumn(TICK, sequence=ticks)]
    yield Chunk.from_columns(entity, indexes, [column for some in columns for column in some])


def timeless(entity: str, *archetypes: rr.AsComponents) -> Iterator[Chunk]:
    """What `entity` is all the time."""
    batches = [batch for archetype in archetypes for batch in archetype.as_component_batches()]
    yield Chunk.from_columns(
        entity, [], [batch.partition([len(batch.as_arrow_array())]) for batch in batches]
    )


def strips(points: NDArray[np.float64]) -> pa.Array:
    """Strips of equally many points, (S, P, 2), as LineStrips2D takes them."""
    count, each, _ = points.shape
    flat = pa.array(np.ascontiguousarray(points, dtype=np.float32).reshape(-1), type=pa.float32())
    pairs = pa.FixedSizeListArray.from_arrays(flat, type=_STRIP.value_type)
    return pa.ListArray.from_arrays(np.arange(0, count * each + 1, each, dtype=np.int32), pairs, type=_STRIP)


def colours(values: Sequence[int]) -> NDArray[np.uint32]:
    """0xRRGGBBAA of each instance."""
    return np.array(values, dtype=np.uint32)


def pixels(radius: float) -> float:
    """A radius in pixels of the screen instead of metres; Rerun tells them apart by the sign."""
    return -radius
