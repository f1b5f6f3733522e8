"""One run as a recording: messages go in, a .rrd file and a live picture come out.

Rules: `take` only keeps the message, so that nothing waits for drawing; all work is in `flush`, which may be
called as often as one likes: a process that is killed leaves a file that is readable up to the last flush.
Rerun is loaded when a `Recording` is made and not before.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from protocol.errors import OdourswarmError
from protocol.messages import Belief, BeliefMap, Event, Field, Halt, Message, Outcome, Truth
from protocol.scenario import Scenario

if TYPE_CHECKING:
    from rerun.chunk import Chunk

    from deploy.recorder.output import RecordingFile
    from deploy.recorder.viewer import LiveViewer


# When a viewer is closed, we say so in one sentence; Rerun would say it in several.
_QUIET = "warn,re_grpc_client=off,re_sdk::recording_stream=off,re_quota_channel=off"


def _to_stderr(sentence: str) -> None:
    print(f"recorder: {sentence}", file=sys.stderr)


class Recording:
    """The recording of one run."""

    def __init__(
        self,
        scenario: Scenario,
        *,
        path: Path | None,
        view: bool,
        run: str,
        say: Callable[[str], None] = _to_stderr,
    ) -> None:
        """Open the file and the viewer.

        Args:
            path: the .rrd file; None: none. What was there is replaced.
            view: open a viewer; if that fails, `say` tells why and recording goes on.
            run: the run's name, and the recording's id.
            say: takes sentences for the person at the terminal; it may be called from another thread.
        Raises: OdourswarmError when neither a file nor a viewer is wanted, or the file cannot be written.
        """
        if path is None and not view:
            raise OdourswarmError("a recording needs a file (--record FILE.rrd), a viewer (--view), or both.")
        os.environ.setdefault("RUST_LOG", _QUIET)
        from deploy.recorder.blueprint import blueprint
        from deploy.recorder.conversion import Batch, Conversion
        from deploy.recorder.output import RecordingFile
        from deploy.recorder.viewer import LiveViewer

        name = f"{run}: {scenario.algorithm}, {scenario.robots} robots, {scenario.topology}, seed {scenario.seed}"
        self._file: RecordingFile | None = None
        self._viewer: LiveViewer | None = None
        if path is not None:
            self._file = RecordingFile(path, run, name, blueprint(scenario, live=False))
        if view:
            self._viewer = LiveViewer(run, name, blueprint(scenario, live=True), say)
        self._conversion = Conversion(scenario, run)
        self._new_batch = Batch
        self._closed = False
        self._begin()
        self._put(list(self._conversion.start()))

    def take(self, message: Message) -> None:
        """Keep `message` until the next flush; other kinds than the recorder's are ignored."""
        keep = self._keep.get(type(message))
        if keep is not None:
            keep(message)

    def flush(self) -> None:
        """Draw what was taken, write it to the disk and offer it to the viewer.

        Raises: OdourswarmError when the disk does not take it.
        """
        batch = self._batch
        self._begin()
        self._put(list(self._conversion.convert(batch)))

    def close(self) -> None:
        """Write what is left, say what was lost, and finish the file; idempotent."""
        if self._closed:
            return
        self._closed = True
        batch = self._batch
        self._begin()
        try:
            self._put(list(self._conversion.convert(batch, last=True)))
        finally:
            if self._viewer is not None:
                self._viewer.close()
            if self._file is not None:
                self._file.close()

    def _begin(self) -> None:
        self._batch = batch = self._new_batch()
        self._keep: dict[type[Message], Callable[..., None]] = {
            Truth: batch.truths.append,
            Belief: batch.beliefs.append,
            BeliefMap: batch.maps.append,
            Field: batch.fields.append,
            Event: batch.events.append,
            Halt: batch.halts.append,
            Outcome: batch.outcomes.append,
        }

    def _put(self, chunks: list[Chunk]) -> None:
        if not chunks:
            return
        if self._viewer is not None:
            self._viewer.offer(chunks)
        file = self._file
        if file is not None:
            self._file = None  # unless it takes them
            file.write(chunks)
            self._file = file
