"""Recordings whose writer was killed in the middle of a write, or whose disk was full.

Rules: Rerun's viewer refuses a file that ends in half a message, and everything before it is good: so the
half is cut off, and nothing else is touched. A file that somebody may still be writing is left alone. Needs
no rerun.

A .rrd file is a 12-byte header, then messages: kind and length of the payload, 8 bytes each, little-endian,
and payload. The index comes last when the file was closed: a message of kind 0, and 32 bytes that say where
it is.
"""

from __future__ import annotations

import os
import struct
import time
from pathlib import Path

_MAGIC = b"RRF2"
_HEADER = 12
_FRAME = struct.Struct("<QQ")
_INDEX, _WHERE = 0, 32
QUIET = 2.0  # s without a write, after which nobody is writing


def whole_length(path: Path) -> int | None:
    """Length of the whole messages in `path`, bytes; None: not a recording as Rerun 0.41 writes it."""
    size = path.stat().st_size
    with path.open("rb") as file:
        if file.read(_HEADER)[:4] != _MAGIC:
            return None
        at = _HEADER
        while len(frame := file.read(_FRAME.size)) == _FRAME.size:
            kind, length = _FRAME.unpack(frame)
            after = at + _FRAME.size + length
            if kind == _INDEX and after + _WHERE <= size:
                return size
            if kind == _INDEX or after > size:
                break
            at = after
            file.seek(at)
    return min(at, size)


def mend(path: Path) -> int:
    """Cut off half a message at the end of `path`; how many bytes that were, 0 as a rule.

    Raises: OSError when the file cannot be read or written.
    """
    status = path.stat()
    whole = whole_length(path)
    if whole is None or whole == status.st_size or time.time() - status.st_mtime < QUIET:
        return 0
    os.truncate(path, whole)
    return status.st_size - whole
