"""The live viewer: a window that is fed by a thread and cannot hold anybody up.

Rules: `offer` never waits. A viewer that is slow misses parts, a viewer that is closed, stuck or cannot open
is given up with one sentence, and recording goes on: Rerun's connection blocks its sender when the viewer
does not read, so only this thread ever touches it, and it asks for an acknowledgement before it sends more.
"""

from __future__ import annotations

import os
import queue
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Sequence

import rerun as rr
import rerun.blueprint as rrb
from rerun.chunk import Chunk

from deploy.recorder.output import APPLICATION, leave_behind

PORT = 9876  # Rerun's own: a viewer that is already open there is used again
MEMORY = "1GiB"  # Rerun's default is three quarters of the machine
WAITING = 256  # flushes that may wait for a slow viewer
START = 20.0  # s that a viewer may take to open
LEAVE = 3.0  # s that a viewer may take to read the rest when the run is over
_LOOK = 0.1  # s


class LiveViewer:
    """A Rerun viewer on this machine."""

    def __init__(self, run: str, name: str, blueprint: rrb.Blueprint, say: Callable[[str], None]) -> None:
        self._say = say
        self._port = PORT
        self._queue: queue.SimpleQueue[Sequence[Chunk] | None] = queue.SimpleQueue()
        self._missed = False
        self._over = False  # given up: what is offered is thrown away
        self._closing = threading.Event()
        self._process: subprocess.Popen[bytes] | None = None
        # The stream lives in the thread's frame only: if it is stuck, nothing waits for it at the end of the process.
        self._thread = threading.Thread(
            target=self._feed, args=(run, name, blueprint), name="viewer", daemon=True
        )
        self._thread.start()

    def offer(self, chunks: Sequence[Chunk]) -> None:
        """Show `chunks` when the viewer gets to it."""
        if self._over:
            return
        if self._queue.qsize() < WAITING:
            self._queue.put(chunks)
        elif not self._missed:
            self._missed = True
            self._say("the viewer cannot keep up and will miss parts of the run.")

    def close(self) -> None:
        """Let the viewer read what is left, for a moment; its window stays open."""
        self._closing.set()
        self._queue.put(None)
        self._thread.join(LEAVE + 1.0)
        if self._thread.is_alive():
            rr.unregister_shutdown()  # or Rerun would wait for the viewer when the process ends

    def _feed(self, run: str, name: str, blueprint: rrb.Blueprint) -> None:
        try:
            trouble = self._open()
            if trouble is None:
                self._send_all(run, name, blueprint)
            else:
                self._give_up(trouble)
        except Exception as error:  # whatever the viewer does, the recording goes on
            self._give_up(f"the viewer failed: {error}")

    def _give_up(self, sentence: str) -> None:
        if not self._over:
            self._over = True
            self._say(sentence)

    def _open(self) -> str | None:
        """Make sure that a viewer listens; or why not."""
        if self._listens():
            return None
        if sys.platform.startswith("linux") and not any(map(os.environ.get, ("DISPLAY", "WAYLAND_DISPLAY"))):
            return "no viewer was opened, because there is no display here (DISPLAY and WAYLAND_DISPLAY are not set)."
        command = [sys.executable, "-m", "rerun", "--port", str(self._port), "--bind", "127.0.0.1"]
        command += ["--memory-limit", MEMORY, "--server-memory-limit", MEMORY, "--expect-data-soon"]
        with tempfile.TemporaryFile() as words:
            # A session of its own: the window outlives the run, and a Ctrl-C in the terminal.
            self._process = process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=words,
                start_new_session=True,
            )
            deadline = time.monotonic() + START
            while process.poll() is None and time.monotonic() < deadline:
                if self._listens():
                    return None
                time.sleep(_LOOK)
            words.seek(0)
            said = words.read().decode(errors="replace").strip().splitlines()
        return f"no viewer was opened: {said[-1] if said else f'it did not start within {START:g} s'}"

    def _listens(self) -> bool:
        try:
            with socket.create_connection(("127.0.0.1", self._port), timeout=_LOOK):
                return True
        except OSError:
            return False

    def _send_all(self, run: str, name: str, blueprint: rrb.Blueprint) -> None:
        stream = rr.RecordingStream(APPLICATION, recording_id=run)
        stream.connect_grpc(f"rerun+http://127.0.0.1:{self._port}/proxy")
        stream.send_recording_name(name)
        stream.send_blueprint(blueprint, make_active=True, make_default=True)
        while (chunks := self._queue.get()) is not None:
            stream.send_chunks(chunks)
            if (trouble := self._acknowledged(stream)) is not None:
                leave_behind(stream)
                self._give_up(trouble)
                return

    def _acknowledged(self, stream: rr.RecordingStream) -> str | None:
        """Wait until the viewer has taken what was sent; or why it will not."""
        left = LEAVE
        while True:
            before = time.monotonic()
            try:
                stream.flush(timeout_sec=_LOOK)
            except RuntimeError as error:
                if "timed out" not in str(error).lower():
                    return "the viewer was closed, or could not open its window."
            else:
                return None
            if self._closing.is_set():
                left -= time.monotonic() - before
                if left <= 0.0:
                    return "the viewer does not answer; it did not get the end of the run."
