"""Who is told while a run goes on."""

from __future__ import annotations

from typing import Protocol

from protocol.messages import Event, Progress


class Watcher(Protocol):
    """The command line's display, or a test's ear."""

    def progress(self, progress: Progress) -> None:
        """How the run goes, some ten times a second."""
        ...

    def event(self, event: Event) -> None:
        """Something that a person wants to know."""
        ...
