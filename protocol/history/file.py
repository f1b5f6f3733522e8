"""Histories as bytes: in a folder with a file per member, or in memory.

    byte 0-3  length of the record, little-endian
    byte 4-7  CRC-32 of the record, little-endian
    byte 8-   msgpack array of the record's kind and fields

Rules: a record goes to the system in one unbuffered write, so that a kill -9 leaves all that was written; what it tore
off at the end is skipped by whoever reads, and cut off by whoever goes on writing. This module belongs to the shells.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Protocol
from zlib import crc32

import msgspec

from protocol.errors import ScenarioError
from protocol.history.records import Record

SUFFIX = ".history"
HEADER = 8

Write = Callable[[Record], None]

_encode = msgspec.msgpack.Encoder().encode
_decode = msgspec.msgpack.Decoder(Record).decode


class Histories(Protocol):
    """Where the members of a run write."""

    def member(self, name: str) -> Write:
        """The pen of member `name` ("world", "robot/3")."""
        ...

    def close(self) -> None:
        """Nobody writes any more."""
        ...


class HistoryFolder:
    """A file per member; one that is there already is gone on with."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._close: list[Callable[[], None]] = []

    def member(self, name: str) -> Write:
        self._folder.mkdir(parents=True, exist_ok=True)
        path = self._folder / (name.replace("/", "-") + SUFFIX)
        file = path.open("ab", buffering=0)
        self._close.append(file.close)
        file.truncate(whole_bytes(path.read_bytes()))
        put = file.write

        def write(record: Record) -> None:
            put(framed(record))

        return write

    def close(self) -> None:
        for close in self._close:
            close()
        self._close.clear()


class HistoryMemory:
    """The same bytes in memory, by member."""

    def __init__(self) -> None:
        self.members: dict[str, bytearray] = {}

    def member(self, name: str) -> Write:
        put = self.members.setdefault(name, bytearray()).extend

        def write(record: Record) -> None:
            put(framed(record))

        return write

    def close(self) -> None:
        return


def framed(record: Record) -> bytes:
    """The bytes of one record."""
    body = _encode(record)
    return b"".join((len(body).to_bytes(4, "little"), crc32(body).to_bytes(4, "little"), body))


def whole_bytes(data: bytes) -> int:
    """How many bytes at the start of `data` are records that were written to their end."""
    at = 0
    while at + HEADER <= len(data):
        end = at + HEADER + int.from_bytes(data[at : at + 4], "little")
        if end > len(data):
            break
        at = end
    return at


def records_in(data: bytes, name: str) -> Iterator[Record]:
    """The records in `data`, without what was torn off at the end.

    Args:
        name: where they are from, for the sentence.
    Raises: ScenarioError when they were damaged.
    """
    view, at, end = memoryview(data), 0, whole_bytes(data)
    while at < end:
        length = int.from_bytes(view[at : at + 4], "little")
        body = view[at + HEADER : at + HEADER + length]
        if crc32(body) != int.from_bytes(view[at + 4 : at + HEADER], "little"):
            raise ScenarioError(f"{name}: the record at byte {at} is damaged; make the history again.")
        try:
            yield _decode(body)
        except msgspec.MsgspecError as error:
            raise ScenarioError(f"{name}: the record at byte {at} is none that this version knows ({error}).") from None
        at += HEADER + length


def refuse_used(folder: Path) -> None:
    """Raises: ScenarioError when a run could not begin its histories in `folder`."""
    if folder.exists() and not folder.is_dir():
        raise ScenarioError(f"--history is {folder}; it must be a folder, and is a file.")
    if folder.is_dir() and any(folder.glob(f"*{SUFFIX}")):
        raise ScenarioError(f"--history is {folder}; it has the history of a run already, give another folder.")
