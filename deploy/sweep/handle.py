"""One worker process, as the sweep holds it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from typing import IO

import msgspec

from deploy.sweep.plan import Job
from deploy.sweep.worker import Answer

# A worker has one processor: numerical libraries that start threads of their own would only get in each other's way.
_ONE_THREAD = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "MKL")}


@dataclass(slots=True)
class Handle:
    """A worker and the run that it has, if any."""

    process: subprocess.Popen[bytes]
    log: IO[bytes]
    job: Job | None = None
    ready: bool = False
    _rest: bytes = field(default=b"")

    @property
    def output(self) -> int:
        """The file descriptor on which its answers come."""
        assert self.process.stdout is not None
        return self.process.stdout.fileno()

    def answers(self) -> Iterator[Answer] | None:
        """What it has said since; None: its output has ended, and so has it."""
        piece = os.read(self.output, 1 << 16)
        if not piece:
            return None
        *lines, self._rest = (self._rest + piece).split(b"\n")
        return (msgspec.json.decode(line, type=Answer) for line in lines)

    def give(self, job: Job) -> None:
        """Let it run `job`."""
        self.job = job
        assert self.process.stdin is not None
        with suppress(BrokenPipeError):  # it has died; the end of its output says so, too
            self.process.stdin.write(msgspec.json.encode(job.scenario) + b"\n")
            self.process.stdin.flush()

    def kill(self) -> None:
        """End it now; it holds nothing that could be lost."""
        if self.process.poll() is None:
            self.process.kill()

    def bury(self) -> str:
        """Clean up after it; how it died, in words."""
        self.kill()
        status = self.process.wait()
        words = self._last_words()
        for pipe in (self.process.stdin, self.process.stdout):
            with suppress(BrokenPipeError):  # what could not be sent any more
                if pipe is not None:
                    pipe.close()
        self.log.close()
        if status >= 0:
            return f"status {status}: {words}"
        with suppress(ValueError):
            return signal.Signals(-status).name
        return f"signal {-status}"

    def _last_words(self) -> str:
        self.log.seek(0)
        lines = [line.strip() for line in self.log.read().decode(errors="replace").split("\n")]
        return next((line for line in reversed(lines) if line), "it said nothing.")


def start(*, check: bool = False) -> Handle:
    """A new worker; it says when it is ready. `check`: it looks whether its runs kept their promises."""
    log = tempfile.TemporaryFile()  # noqa: SIM115  (open as long as the worker)
    process = subprocess.Popen(
        [sys.executable, "-m", "deploy.sweep.worker", *(["--check"] if check else [])],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=log,
        env=os.environ | _ONE_THREAD,
    )
    return Handle(process, log)
