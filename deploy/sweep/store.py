"""What is finished of a sweep, on disk.

    RESULT.parquet           the runs of the spec, in its order
    RESULT.parts/            one file per run that finished since, moved into place when complete; the lock
    RESULT.aside.parquet     finished runs that the spec does not have (any more): kept, and used again if it has

Rules: killed at any point, nothing that was finished is lost: a row is written to its new place before it is removed
from the old one, and a row in two places is one row, for its digest names it.
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pyarrow as pa

from deploy.sweep import rows as r
from deploy.sweep.axes import PLOT
from deploy.sweep.code import our_version
from deploy.sweep.plan import Plan
from deploy.sweep.rows import Row
from protocol.errors import ScenarioError

MOST_PARTS = 1000  # then they are put together while the sweep goes on


def parts_of(out: Path) -> Path:
    """The folder of a result's parts."""
    return out.with_suffix(".parts")


def aside_of(out: Path) -> Path:
    """The file of the runs that the spec does not have."""
    return out.with_suffix(".aside.parquet")


def finished(out: Path, *, aside: bool = False) -> dict[str, Row]:
    """All finished runs by digest, also while a sweep is at work.

    Raises: ScenarioError when `out` is not the result of a sweep.
    """
    # The parts first: a part that vanishes meanwhile has been moved into the file that is read afterwards.
    found: dict[str, Row] = {}
    for part in sorted(parts_of(out).glob("*.parquet")):
        # A part that cannot be read is of a disk that lost power: its run is done again.
        with suppress(FileNotFoundError, ScenarioError):
            found |= r.by_digest(r.read_table(part).to_pylist())
    for file in (out, *([aside_of(out)] if aside else [])):
        with suppress(FileNotFoundError):
            found = r.by_digest(r.read_table(file).to_pylist()) | found
    return found


def grid_of(out: Path, rows: list[Row]) -> tuple[str, ...]:
    """The values that tell the cells of a result apart, as its spec had them."""
    with suppress(FileNotFoundError):
        return tuple(filter(None, r.read_notes(r.read_table(out)).get("grid", "").split("\n")))
    # Only parts so far: whatever is not measured.
    return tuple(dict.fromkeys(name for row in rows for name in row if name not in ("label", PLOT, *r.MEASURED)))


class Store:
    """The finished runs of a plan; whoever has one holds the lock."""

    rows: dict[str, Row]  # of the plan, by digest
    ignored: int  # finished runs that the plan does not have
    foreign: int  # finished runs of the plan that other code made

    def __init__(self, out: Path, plan: Plan) -> None:
        self._out, self._plan = out, plan
        self._parts = parts_of(out)
        for left in self._parts.glob("*.tmp"):
            left.unlink()
        known = finished(out, aside=True)
        self.rows = {job.digest: r.relabel(job, known.pop(job.digest)) for job in plan.jobs if job.digest in known}
        self.ignored = len(known)
        self.foreign = sum(row["version"] != our_version() for row in self.rows.values())
        self._aside = known
        self._pending = 0
        self.compact()

    def add(self, row: Row) -> None:
        """Keep a finished run; when this returns it is on the disk."""
        digest = str(row["scenario_digest"])
        # Known before it is written: a Ctrl-C in between must not let `compact` take the part for one that it has.
        self.rows[digest] = row
        r.write_table(r.make_table([row], {}), self._parts / f"{digest}.parquet", self._parts)
        self._pending += 1
        if self._pending >= MOST_PARTS:
            self.compact()

    def compact(self) -> None:
        """Bring everything that is finished into the result's file."""
        mine = [self.rows[job.digest] for job in self._plan.jobs if job.digest in self.rows]
        if self._aside:
            self._write(r.make_table(list(self._aside.values()), {}), aside_of(self._out))
        if mine:
            notes = {"grid": "\n".join(self._plan.varied), "title": self._plan.spec.title}
            self._write(r.make_table(mine, notes), self._out)
        elif self._aside:
            self._out.unlink(missing_ok=True)  # all of its runs are aside now
        if not self._aside:
            aside_of(self._out).unlink(missing_ok=True)  # all of its runs are in the result now
        for part in self._parts.glob("*.parquet"):
            part.unlink()
        self._pending = 0

    def _write(self, table: pa.Table, file: Path) -> None:
        """Put `table` into `file`, unless it is there already."""
        with suppress(FileNotFoundError):
            if r.read_table(file).equals(table, check_metadata=True):
                return
        r.write_table(table, file, self._parts)


def forget(out: Path) -> None:
    """Remove every finished run of a result."""
    for file in (*parts_of(out).glob("*.parquet"), aside_of(out), out):
        file.unlink(missing_ok=True)
