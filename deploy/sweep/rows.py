"""A finished run as one row of a table, and tables as files.

Rules: a row is named by its `scenario_digest`; a file is complete or not there: it is written beside its place, brought
to the disk and moved.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from deploy.sweep.axes import PLOT
from deploy.sweep.code import our_version
from deploy.sweep.plan import Job
from protocol.errors import ScenarioError
from protocol.messages import Outcome

Row = dict[str, Any]

# What a run gives, with the units of `Outcome`.
MEASURED: dict[str, pa.DataType] = {
    "seed": pa.int64(),
    "scenario_digest": pa.string(),
    "found": pa.bool_(),
    "time": pa.float64(),  # simulated s at the end of the run
    "finder": pa.int64(),  # -1: nobody
    "first_detection": pa.float64(),  # s; null: nobody met the odour
    "min_pair_distance": pa.float64(),  # m; null with one robot
    "distance_travelled": pa.list_(pa.float64()),  # m, per robot
    "estimate_error": pa.list_(pa.float64()),  # m, per robot; null: it has no estimate
    "disagreement": pa.float64(),  # m, largest distance of two estimates; null: fewer than two, or measured by older code
    "digest": pa.string(),  # of the truth: two runs with the same digest were the same to the bit
    "ticks": pa.int64(),
    "wall_s": pa.float64(),
    "ended": pa.string(),
    "reached_at": pa.float64(),  # s; null: nobody reached the source (or a result from before robots could declare)
    "declared": pa.bool_(),  # every live robot told one and the same place
    "declared_at": pa.float64(),  # s
    "declared_by": pa.int64(),
    "declared_x": pa.float64(),  # m
    "declared_y": pa.float64(),
    "declaration_error": pa.float64(),  # m
    "declaration_delay": pa.float64(),  # from reaching to declaring, s
    "false_declaration": pa.bool_(),
    "version": pa.string(),  # of odourswarm
    "kept": pa.bool_(),  # the run kept its promises; null: it was not checked
    "broken": pa.string(),  # name of the first promise that it broke, "": none
}
OURS = ("version", "kept", "broken")  # of these, what `Outcome` does not say
NEEDED = ("label", "algorithm", "max_time", "scenario_digest", "found", "time")  # without these it is something else
_TYPES: dict[type, pa.DataType] = {bool: pa.bool_(), int: pa.int64(), float: pa.float64(), str: pa.string()}


def make_row(job: Job, outcome: Outcome, broken: str | None = None) -> Row:
    """The row of a run that is over; `broken` is what the checkers said, None when they were not asked."""
    measured = {name: getattr(outcome, name) for name in MEASURED if name not in OURS}
    kept = None if broken is None else not broken
    return {**_named(job), **measured, "version": our_version(), "kept": kept, "broken": broken}


def relabel(job: Job, row: Row) -> Row:
    """A row of the same run, with the columns that the plan has now."""
    return {**_named(job), **{name: row.get(name) for name in MEASURED}}


def _named(job: Job) -> Row:
    """What a row has from the plan."""
    return {"label": job.label, **job.values, **({} if job.plot is None else {PLOT: job.plot})}


def make_table(rows: Sequence[Row], notes: Mapping[str, str]) -> pa.Table:
    """The rows as a table; a column that a row has not is null there."""
    names = dict.fromkeys(name for row in rows for name in row)
    columns = {name: _column(name, [row.get(name) for row in rows]) for name in names}
    table = pa.table(columns)
    return table.replace_schema_metadata({f"odourswarm.{key}": text for key, text in notes.items()})


def _column(name: str, values: list[Any]) -> pa.Array:
    if name in MEASURED:
        return pa.array(values, MEASURED[name])
    kinds = {type(value) for value in values if value is not None}
    if kinds <= {int, float} and kinds:
        return pa.array(values, pa.float64() if float in kinds else pa.int64())
    if len(kinds) == 1:
        return pa.array(values, _TYPES[kinds.pop()])
    return pa.array([None if value is None else str(value) for value in values], pa.string())


def write_table(table: pa.Table, file: Path, scratch: Path) -> None:
    """Put `table` into `file`; `scratch` is a folder on the same disk for what is not complete yet.

    Raises: OSError when it cannot be written.
    """
    part = scratch / f"{file.name}.tmp"
    with part.open("wb") as sink:
        pq.write_table(table, sink, compression="zstd")
        sink.flush()
        os.fsync(sink.fileno())
    os.replace(part, file)
    folder = os.open(file.parent, os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def read_table(file: Path) -> pa.Table:
    """The table in `file`.

    Raises:
        FileNotFoundError: there is none.
        ScenarioError: it is not the result of a sweep.
    """
    try:
        with file.open("rb") as source:
            table = pq.read_table(source)
    except FileNotFoundError:
        raise
    except PermissionError:
        raise ScenarioError(f"{file}: there is no permission to read it; give the result of a sweep.") from None
    except (pa.ArrowException, OSError):
        raise ScenarioError(f"{file}: it is not a Parquet file; give the result of a sweep.") from None
    if missing := [name for name in NEEDED if name not in table.column_names]:
        raise ScenarioError(f'{file}: it has no column "{missing[0]}"; give the result of a sweep.')
    return table


def read_notes(table: pa.Table) -> dict[str, str]:
    """What `make_table` was told to note."""
    metadata: dict[bytes, bytes] = table.schema.metadata or {}
    prefix = b"odourswarm."
    return {key[len(prefix) :].decode(): text.decode() for key, text in metadata.items() if key.startswith(prefix)}


def by_digest(rows: Iterable[Row]) -> dict[str, Row]:
    """The rows by their names; the last of a name counts."""
    return {str(row["scenario_digest"]): row for row in rows}

