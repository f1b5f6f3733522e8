"""Checkpoints of a world in a folder, and the journal of what has happened since, so that a killed world can come back.

    {run}-{tick}.checkpoint   the world and its session at `tick`, written beside and renamed: whole or not there
    {run}-{tick}.journal      what came from outside since: length, CRC-32 and msgpack array of each input

Rules: an input goes to the system in one unbuffered write before anybody is told what follows from it; so a kill -9 of
the process loses nothing (a machine that loses its power may lose the last seconds). A journal is there before its
checkpoint, and the ones before are removed after it: at every moment one pair is complete. This module belongs to the shell.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from io import FileIO
from pathlib import Path
from zlib import crc32

import msgspec
from msgspec import Struct

from protocol.errors import SwarmFailure
from protocol.history.file import HEADER, whole_bytes
from world_server.recoverable import Input

VERSION = 1
CHECKPOINT, JOURNAL = ".checkpoint", ".journal"

_encode = msgspec.msgpack.Encoder().encode
_decode_input = msgspec.msgpack.Decoder(Input).decode


class Checkpoint(Struct, frozen=True, array_like=True):
    """A run at one tick."""

    version: int
    run: str
    scenario: str  # digest
    tick: int
    world: bytes
    session: bytes
    wall_s: float  # since the first tick


Saved = tuple[Checkpoint, list[Input]]


@dataclass(slots=True)
class Checkpoints:
    """The files of one run."""

    folder: Path
    run: str
    scenario: str  # digest
    _journal: FileIO | None = field(default=None, init=False)

    def write(self, tick: int, world: bytes, session: bytes, wall_s: float) -> None:
        """Write the checkpoint of `tick` and begin its journal."""
        self.folder.mkdir(parents=True, exist_ok=True)
        before = self._files()
        self._open_journal(tick, "wb")
        path = self._path(tick, CHECKPOINT)
        beside = path.with_suffix(".part")
        beside.write_bytes(_encode(Checkpoint(VERSION, self.run, self.scenario, tick, world, session, wall_s)))
        beside.replace(path)
        for old in before:
            if old.stem != path.stem:
                old.unlink(missing_ok=True)

    def note(self, happened: Input) -> None:
        """Add to the journal; before the first checkpoint there is none, and a world that is killed then begins anew."""
        if self._journal is not None:
            body = _encode(happened)
            frame = b"".join((len(body).to_bytes(4, "little"), crc32(body).to_bytes(4, "little"), body))
            self._journal.write(frame)

    def load(self) -> Saved | None:
        """The last checkpoint and what happened since; None when there is none. The journal is gone on with.

        Raises: SwarmFailure when it cannot be read.
        """
        found = [(self._tick_of(path), path) for path in self._files() if path.suffix == CHECKPOINT]
        if not found:
            return None
        tick, path = max(found)
        try:
            data = path.read_bytes()
            version = msgspec.msgpack.decode(data)[0]
            if version != VERSION:
                raise SwarmFailure(f"{path} is a checkpoint of version {version}; this world reads version {VERSION} only.")
            checkpoint = msgspec.msgpack.decode(data, type=Checkpoint)
        except (msgspec.MsgspecError, TypeError, IndexError, KeyError, ValueError) as error:
            raise SwarmFailure(f"{path} is no checkpoint of a world ({error}); remove it to begin the run anew.") from None
        if checkpoint.scenario != self.scenario:
            raise SwarmFailure(f"{path} is of another scenario than the one given; remove it, or give the same scenario.")
        inputs = self._read_journal(tick)
        self._open_journal(tick, "ab")
        return checkpoint, inputs

    def close(self, *, remove: bool) -> None:
        """Write no more; `remove`: the run is over, there is nothing to come back to."""
        if self._journal is not None:
            self._journal.close()
            self._journal = None
        if remove:
            for path in self._files():
                path.unlink(missing_ok=True)

    def _read_journal(self, tick: int) -> list[Input]:
        path = self._path(tick, JOURNAL)
        data = path.read_bytes() if path.exists() else b""
        end = whole_bytes(data)
        inputs: list[Input] = []
        at = 0
        while at < end:
            length = int.from_bytes(data[at : at + 4], "little")
            body = data[at + HEADER : at + HEADER + length]
            if crc32(body) != int.from_bytes(data[at + 4 : at + HEADER], "little"):
                raise SwarmFailure(f"{path} is damaged at byte {at}; remove it and its checkpoint to begin the run anew.")
            inputs.append(_decode_input(body))
            at += HEADER + length
        if end < len(data):  # torn off; nobody was told what would have followed
            with path.open("r+b") as file:
                file.truncate(end)
        return inputs

    def _open_journal(self, tick: int, mode: str) -> None:
        if self._journal is not None:
            self._journal.close()
        self._journal = FileIO(self._path(tick, JOURNAL), mode)

    def _path(self, tick: int, suffix: str) -> Path:
        return self.folder / f"{self.run}-{tick}{suffix}"

    def _files(self) -> list[Path]:
        """All of this run, half-written ones too."""
        if not self.folder.is_dir():
            return []
        mine = (CHECKPOINT, JOURNAL, ".part")
        return [path for path in self.folder.iterdir() if path.suffix in mine and self._tick_of(path) >= 0]

    def _tick_of(self, path: Path) -> int:
        run, _, tick = path.stem.rpartition("-")
        return int(tick) if run == self.run and tick.isdecimal() else -1
