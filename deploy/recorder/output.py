"""The file: a Rerun stream of its own, handed to the operating system whenever it is asked to.

A chunk costs some 1.5 kB besides its numbers, so that a long run with many flushes is mostly chunks; such a
file is packed when it is closed. A file that was never closed is as readable, only larger and slower to open.
"""

from __future__ import annotations

import contextlib
import ctypes
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import rerun as rr
import rerun.blueprint as rrb
from rerun.chunk import Chunk

from protocol.errors import OdourswarmError

APPLICATION = "odourswarm"
MANY = 400  # chunks: a file with more of them is packed
WRITING = 15.0  # s that the disk may take
PACKING = 30.0  # s that packing may take; it takes less than one


def leave_behind(stream: rr.RecordingStream) -> None:
    """Never touch `stream` again.

    Rerun would wait for ever for a disk that is full or a viewer that does not read: when the stream is
    closed, when it is collected, and when the process ends.
    """
    rr.unregister_shutdown()
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(stream))


class RecordingFile:
    """A .rrd file that is readable up to the last `write`, however the process ends."""

    def __init__(self, path: Path, run: str, name: str, blueprint: rrb.Blueprint) -> None:
        """Open `path` for writing; what was there is replaced.

        Raises: OdourswarmError when nothing can be written there.
        """
        self._path = path
        self._chunks = 0
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.open("wb").close()  # Rerun's own complaint would come from another thread
        except OSError as error:
            raise OdourswarmError(
                f"cannot record to {path}: {error.strerror or error}; name a file in a folder that you may write to."
            ) from None
        self._stream = rr.RecordingStream(APPLICATION, recording_id=run)
        if not rr.is_enabled(self._stream):
            raise OdourswarmError(
                "nothing can be recorded, because the environment says RERUN=off; unset it."
            )
        self._stream.save(path, default_blueprint=blueprint)
        self._stream.send_recording_name(name)

    def write(self, chunks: Sequence[Chunk]) -> None:
        """Append `chunks` and hand them to the operating system.

        Raises: OdourswarmError when the disk does not take them; the file is lost for what comes after.
        """
        self._chunks += len(chunks)
        try:
            self._stream.send_chunks(chunks)
            self._stream.flush(timeout_sec=WRITING)
        except (RuntimeError, ValueError, OSError) as error:
            leave_behind(self._stream)
            raise OdourswarmError(
                f"cannot go on recording to {self._path} ({error}); is the disk full? It holds the run so far."
            ) from None

    def close(self) -> None:
        """Write the index at the end of the file, and pack it when it holds many chunks."""
        self._stream.disconnect()
        if self._chunks > MANY:
            self._pack()

    def _pack(self) -> None:
        packed = self._path.with_name(self._path.name + ".packing")
        command = [sys.executable, "-m", "rerun", "rrd", "optimize", str(self._path), "-o", str(packed)]
        # Packing is a favour: when it fails, the file is good as it is.
        with contextlib.suppress(OSError, subprocess.SubprocessError):
            subprocess.run(
                command, stdin=subprocess.DEVNULL, capture_output=True, timeout=PACKING, check=True
            )
            packed.replace(self._path)
        with contextlib.suppress(OSError):
            packed.unlink(missing_ok=True)
