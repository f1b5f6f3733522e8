"""A made-up run in closed form, and recordings read back: what goes in and what came out.

As a program it records such a run in a process of its own: `recorder_helpers.py STORY FILE.rrd`.
"""

from __future__ import annotations

import math
import struct
import sys
import warnings
from pathlib import Path

import msgspec

from protocol.messages import NEVER, Belief, Event, Field, Halt, Message, Outcome, Truth
from protocol.scenario import Scenario

N = 4
DT = 0.05
SOURCE = (10.0, 0.0)
RING = tuple((i, j, 1.0) for i in range(N) for j in ((i - 1) % N, (i + 1) % N))


def scenario(**values) -> Scenario:
    """Four robots in a ring."""
    return msgspec.structs.replace(Scenario(robots=N, topology="ring", graph=RING), **values)


def pose(i: int, t: float) -> tuple[float, float, float]:
    """x, y, theta of robot `i`: upwind in a slow wave."""
    return 95.0 - 0.5 * t, -6.0 + 4.0 * i + 2.0 * math.sin(0.1 * t), math.pi - 0.4 * math.cos(0.1 * t)


def ppt(i: int, t: float) -> float:
    return 400.0 * i + 10.0 * t


def estimate(i: int, t: float) -> tuple[float, float]:
    """h^ic of robot `i`: it nears the source."""
    return 10.0 + (40.0 - i) * math.exp(-0.05 * t), 0.5 * i


def truth(tick: int, count: int, dead: frozenset[int] = frozenset()) -> Truth:
    t = tick * DT
    rows = (struct.pack("<9d", *pose(i, t), 0.5, 0.02 * i, 0.1, 0.2, ppt(i, t), float(i not in dead)) for i in range(N))
    return Truth(tick, t, count, b"".join(rows))


def field(tick: int, nodes: int = 21) -> Field:
    t = tick * DT
    plume = b"".join(struct.pack("<3f", 10.0 + 0.9 * k, math.sin(0.3 * k + t), 0.5 + 0.001 * k) for k in range(90))
    wind = b"".join(struct.pack("<2f", 1.0, 0.1 * math.sin(x + t)) for x in range(nodes) for _ in range(nodes))
    return Field(tick, t, plume, wind)


def belief(i: int, tick: int, links: tuple[int, ...] | None = None, heard: tuple[int, ...] | None = None) -> Belief:
    t = tick * DT
    sure = t >= 3.0
    ring = tuple(sorted(((i - 1) % N, (i + 1) % N)))
    h_x, h_y = estimate(i, t)
    return Belief(
        robot=i, tick=tick, t=t, mode="trace" if sure else "search", has_estimate=sure, h_x=h_x, h_y=h_y,
        x_hat_x=h_x + 1.0, x_hat_y=h_y, variance=400.0 / (1.0 + t), fusion_x=h_x, fusion_y=h_y,
        target_x=pose(i, t)[0] - 5.0, target_y=pose(i, t)[1], detected_at=t if sure else NEVER,
        heard=ring if heard is None else heard, links=ring if links is None else links, dropped=0, refused=0,
    )  # fmt: skip


def outcome() -> Outcome:
    return Outcome(
        found=True, time=20.0, finder=2, ticks=400, wall_s=1.0, ticks_per_s=400.0, digest="d", run="story", seed=1,
        distance_travelled=(1.0,) * N, estimate_error=(0.5, 0.6, None, 0.7), min_pair_distance=2.0,
        scenario_digest="s", faults=(), messages={}, ended="found", failed=False, first_detection=3.0,
    )  # fmt: skip


def messages(seconds: float = 20.0, *, dies: dict[int, float] | None = None, mute: frozenset[int] = frozenset()):
    """The messages of a run, in the order of time: truth at 10 Hz, plume at 2 Hz, beliefs at 1 Hz.

    Args:
        dies: when robots die, s.
        mute: robots that never report.
    """
    dies = dies or {}
    said: list[Message] = [Event(0, 0.0, -1, "the run begins")]
    for count, tick in enumerate(range(0, round(seconds / DT) + 1, 2)):
        t = tick * DT
        dead = frozenset(i for i, when in dies.items() if t >= when)
        if tick % 20 == 0:
            for i in sorted(frozenset(range(N)) - dead - mute):
                links = tuple(j for j in sorted(((i - 1) % N, (i + 1) % N)) if j not in dead)
                said.append(belief(i, tick, links=links, heard=links))
        said.append(truth(tick, count, dead))
        if tick % 10 == 0:
            said.append(field(tick))
        said += [
            Event(tick, t, i, f"robot {i} lost at {t:.2f} s") for i, when in dies.items() if when <= t < when + 0.1
        ]
    return [*said, Halt(round(seconds / DT), "found"), outcome()]


class Read:
    """A recording, read back with Rerun's own reader."""

    def __init__(self, path: Path) -> None:
        from rerun.chunk import RrdReader

        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # it remarks that a file that was never closed has no index
            reader = RrdReader(path)
        self.ids = [(entry.application_id, entry.recording_id) for entry in reader.recordings()]
        self.chunks = list(reader.stream().to_chunks())
        self.blueprint = [chunk for entry in reader.blueprints() for chunk in reader.stream(store=entry).to_chunks()]

    def entities(self) -> set[str]:
        return {chunk.entity_path for chunk in self.chunks}

    def rows(self, entity: str, component: str) -> list[tuple[float, int, list]]:
        """(simulated s, tick, value) of every row, in the order of time."""
        rows = []
        for chunk in self.chunks:
            batch = chunk.to_record_batch()
            if chunk.entity_path == entity and not chunk.is_static and component in batch.schema.names:
                times = batch.column("sim_time").cast("int64").to_pylist()
                values = batch.column(component).to_pylist()
                rows += zip((1e-9 * t for t in times), batch.column("tick").to_pylist(), values, strict=True)
        return sorted(rows, key=lambda row: row[0])

    def at(self, entity: str, component: str, t: float) -> list:
        """Latest value at `t`; nothing when there is none yet."""
        return next((value for when, _, value in reversed(self.rows(entity, component)) if when <= t + 1e-6), [])

    def always(self, entity: str, component: str) -> list:
        """The value that holds all the time; the last one that was written."""
        found = [chunk.to_record_batch() for chunk in self.chunks if chunk.entity_path == entity and chunk.is_static]
        return [b.column(component).to_pylist()[-1] for b in found if component in b.schema.names][-1]

    def blueprint_values(self, component: str) -> list:
        batches = [chunk.to_record_batch() for chunk in self.blueprint]
        return [
            v for b in batches if component in b.schema.names for row in b.column(component).to_pylist() for v in row
        ]


def record(path: Path, said: list[Message], *, flush_every: int = 10**9, of: Scenario | None = None) -> Read:
    """Record `said` and read it back."""
    from deploy.recorder import Recording

    recording = Recording(of or scenario(), path=path, view=False, run="story")
    for k, message in enumerate(said, 1):
        recording.take(message)
        if k % flush_every == 0:
            recording.flush()
    recording.close()
    return Read(path)


def _flush_and_wait(path: Path) -> None:
    """Flush ten seconds of a run, say so, take the rest, and wait to be killed."""
    from deploy.recorder import Recording

    recording = Recording(scenario(), path=path, view=False, run="story")
    for message in messages(10.0)[:-2]:
        recording.take(message)
    recording.flush()
    for message in messages(20.0):
        recording.take(message)
    print("flushed", flush=True)
    sys.stdin.read()


def _disk_full(path: Path) -> None:
    """Record while no file may grow beyond 256 kB."""
    import resource

    from deploy.recorder import Recording, output
    from protocol.errors import OdourswarmError

    output.WRITING = 1.0
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 18, 1 << 18))
    recording = Recording(scenario(), path=path, view=False, run="story")
    for message in messages(20.0):
        recording.take(message)
    try:
        recording.flush()
    except OdourswarmError as error:
        print(error, flush=True)
    recording.flush()
    recording.close()


def _stuck_viewer(path: Path) -> None:
    """Record and show, and leave as the recorder's process does; on the viewer's port listens one who never answers."""
    import socket

    from deploy.recorder import Recording, viewer
    from protocol.shell import EXIT_OK, leave

    with socket.create_server(("127.0.0.1", 0)) as stuck:
        viewer.PORT = stuck.getsockname()[1]
        viewer.LEAVE = 0.5
        recording = Recording(scenario(), path=path, view=True, run="story", say=lambda s: print(s, flush=True))
        for k, message in enumerate(messages(20.0)):
            recording.take(message)
            if k % 50 == 0:
                recording.flush()
        recording.close()
        leave(EXIT_OK)


if __name__ == "__main__":
    {"flush-and-wait": _flush_and_wait, "disk-full": _disk_full, "stuck-viewer": _stuck_viewer}[sys.argv[1]](
        Path(sys.argv[2])
    )
