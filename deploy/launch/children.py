"""The processes of a run: started together, never left behind.

Rules: every child is on a leash (its standard input is a pipe that ends with the launcher, however the launcher ends) and
leaves a Ctrl-C at the terminal to the launcher. (A session of its own for each would be tidier, but the kernel shares
the processor out by sessions, and the swarm would run slower.) What a child writes to its standard error is kept for the
sentence that says why it failed.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

POLL = 0.01  # s
PIPE = 1 << 16  # bytes that a pipe takes before anybody reads


@dataclass(slots=True)
class Child:
    """One process of the run."""

    name: str
    process: subprocess.Popen[bytes]
    log: Path
    python: str = sys.executable  # the interpreter that it is, once what it was started through has given way

    @property
    def status(self) -> int | None:
        """Exit status, or None while it runs; negative: the signal that ended it."""
        return self.process.poll()

    def last_words(self) -> str:
        """The last line it wrote to its standard error."""
        try:
            lines = self.log.read_text(encoding="utf-8", errors="replace").split("\n")
        except OSError:
            return ""
        return next((line.strip() for line in reversed(lines) if line.strip()), "")


@dataclass(slots=True)
class Children:
    """All processes of the run."""

    folder: Path
    members: dict[str, Child] = field(default_factory=dict)

    def start(
        self,
        name: str,
        module: str,
        arguments: Sequence[str],
        *,
        through: Sequence[str] = (),
        python: str = sys.executable,
        handed: bytes = b"",
    ) -> Child:
        """Start `through python -m module arguments` as member `name`.

        Args:
            through: what the command begins with, such as `ssh lab-2`; standard input has to pass through it.
            handed: a line for its standard input, which is its leash from then on.
        """
        if (before := self.members.get(name)) is not None and before.process.stdin is not None:
            before.process.stdin.close()  # it has ended; this one takes its place
        log = self.folder / f"{name.replace('/', '-')}.err"
        with log.open("wb") as stderr:
            process = subprocess.Popen(
                [*through, python, "-m", module, *arguments, "--leash"],
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=stderr,
                pipesize=len(handed) + 1 if len(handed) >= PIPE else -1,  # so that handing over does not wait
            )
        child = self.members[name] = Child(name, process, log, python)
        if handed and process.stdin is not None:
            with suppress(BrokenPipeError):  # it has ended already; why is asked elsewhere
                process.stdin.write(handed + b"\n")
                process.stdin.flush()
        return child

    def failed(self, names: Iterable[str] | None = None) -> list[Child]:
        """Those that ended with a status other than 0."""
        chosen = self.members if names is None else {n: self.members[n] for n in names if n in self.members}
        return [child for child in chosen.values() if child.status not in (None, 0)]

    def wait(self, timeout: float, names: Iterable[str] | None = None) -> bool:
        """Wait for all (or `names`) to end; whether they did within `timeout` seconds."""
        deadline = time.monotonic() + timeout
        waited_for = [self.members[n] for n in (self.members if names is None else names) if n in self.members]
        while any(child.status is None for child in waited_for):
            if time.monotonic() > deadline:
                return False
            time.sleep(POLL)
        return True

    def end(self, patience: float) -> None:
        """End everyone: ask, wait `patience` seconds, kill. Also those that are stopped (SIGSTOP)."""
        for child in self.members.values():
            if child.status is None:
                child.process.terminate()
        if not self.wait(patience):
            for child in self.members.values():
                if child.status is None:
                    child.process.kill()
        for child in self.members.values():
            child.process.wait()
            if child.process.stdin is not None:
                child.process.stdin.close()
