"""One sweep at a time for one result.

Rules: the lock is the kernel's and dies with the process, however that ends; the file of the lock may stay behind and
means nothing then.
"""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from protocol.errors import ScenarioError

NAME = "lock"


@contextmanager
def only_one(folder: Path, out: Path) -> Iterator[None]:
    """Hold `folder`, made when it is not there, for the result `out`.

    Raises: ScenarioError when another process holds it.
    """
    file = folder / NAME
    handle = _take(file, out)
    try:
        os.ftruncate(handle, 0)
        os.pwrite(handle, str(os.getpid()).encode(), 0)
        yield
    finally:
        # Removed while it is held, so that nobody can have it in between; the folder goes when nothing is in it.
        file.unlink(missing_ok=True)
        with suppress(OSError):
            folder.rmdir()
        os.close(handle)


def _take(file: Path, out: Path) -> int:
    while True:
        file.parent.mkdir(parents=True, exist_ok=True)
        try:
            handle = os.open(file, os.O_RDWR | os.O_CREAT, 0o644)
        except FileNotFoundError:
            continue  # a sweep that ended has just removed the folder
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            holder = os.pread(handle, 32, 0).decode(errors="replace").strip()
            os.close(handle)
            who = f"process {holder}" if holder else "another process"
            sentence = f"{out}: another sweep ({who}) writes it now; wait for its end, or give this one --out FILE."
            raise ScenarioError(sentence) from None
        # A sweep that ended may have removed the file between our open and our lock: then we hold nothing.
        with suppress(FileNotFoundError):
            if os.path.samestat(os.stat(file), os.fstat(handle)):
                return handle
        os.close(handle)
