"""What a person sees while a run goes on."""

from __future__ import annotations

from types import TracebackType

from rich.console import Console
from rich.live import Live
from rich.text import Text

from protocol.messages import Event, Progress
from protocol.scenario import Scenario


class Display:
    """A line of progress on stderr, and the events above it; nothing at all when `quiet`."""

    def __init__(self, scenario: Scenario, *, quiet: bool) -> None:
        self._scenario = scenario
        self._source = scenario.plume.release_rate > 0.0
        self._console = Console(stderr=True, quiet=quiet, highlight=False)
        self._live: Live | None = None
        if not quiet and self._console.is_terminal:
            self._live = Live(self._line(None), console=self._console, refresh_per_second=10, transient=True)

    def __enter__(self) -> Display:
        s = self._scenario
        self._console.print(
            f"{s.robots} robots, [bold]{s.algorithm}[/bold] on [bold]{s.topology}[/bold], "
            f"wind {s.wind.speed:g} m/s, seed {s.seed}"
        )
        if self._live is not None:
            self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._live is not None:
            self._live.stop()

    def progress(self, progress: Progress) -> None:
        """How the run goes."""
        if self._live is not None:
            self._live.update(self._line(progress))

    def event(self, event: Event) -> None:
        """Something that a person wants to know."""
        who = f"robot {event.robot}: " if event.robot >= 0 and not event.text.startswith("robot") else ""
        self._console.print(Text.assemble((f"{event.t:8.2f} s  ", "dim"), f"{who}{event.text}"), soft_wrap=True)

    def _line(self, p: Progress | None) -> Text:
        if p is None:
            return Text("the swarm links up ...", style="dim")
        return Text.assemble(
            (f"{p.t:8.1f} s  ", "bold"),
            f"{p.live}/{self._scenario.robots} robots",
            f", {p.detections} detections, the nearest {p.closest:.1f} m from the source" if self._source else "",
        )
