"""From messages to chunks: knows which layer draws what, and what must be remembered between two flushes.

Rules: one chunk per entity and flush; nothing that a stranger could send raises.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from rerun.chunk import Chunk

from deploy.recorder.decisions import Board
from deploy.recorder.layers import events
from deploy.recorder.layers.bodies import BodyLayer
from deploy.recorder.layers.fields import FieldLayer
from deploy.recorder.layers.graph import GraphLayer
from deploy.recorder.layers.maps import MapLayer
from deploy.recorder.layers.scenery import scenery
from deploy.recorder.layers.thoughts import ThoughtLayer
from deploy.recorder.links import LinkWatch
from deploy.recorder.track import Gaps, track_of
from protocol.messages import Belief, BeliefMap, Event, Field, Halt, Outcome, Truth
from protocol.scenario import Scenario


@dataclass(slots=True)
class Batch:
    """Messages that arrived since the last flush."""

    truths: list[Truth] = field(default_factory=list)
    fields: list[Field] = field(default_factory=list)
    beliefs: list[Belief] = field(default_factory=list)
    maps: list[BeliefMap] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    halts: list[Halt] = field(default_factory=list)
    outcomes: list[Outcome] = field(default_factory=list)


class Conversion:
    """Turns the batches of one run into chunks."""

    def __init__(self, scenario: Scenario, run: str) -> None:
        self._scenario = scenario
        self._run = run
        period = scenario.timing.decision
        self._watch = LinkWatch(
            scenario.graph, scenario.robots, period, scenario.schedule, scenario.graph_options.period
        )
        self._board: Board[Belief] = Board(scenario.robots, period)
        self._bodies = BodyLayer(scenario)
        self._fields = FieldLayer(scenario)
        self._thoughts = ThoughtLayer(scenario)
        self._maps = MapLayer(scenario)
        self._graph = GraphLayer(scenario, self._watch)
        self._gaps = Gaps()
        self._live = frozenset(range(scenario.robots))
        self._now = (0, 0.0)  # tick and simulated s of the newest truth
        self._misfits = 0

    def start(self) -> Iterator[Chunk]:
        """What is known before the first message."""
        yield from scenery(self._scenario)
        for layer in (self._fields, self._graph, self._bodies, self._thoughts):
            yield from layer.static()
        yield from events.document(self._run, self._scenario, None)

    def convert(self, batch: Batch, *, last: bool = False) -> Iterator[Chunk]:
        """What `batch` shows; the `last` time everything that waited as well, and what was lost."""
        track, misfits = track_of(batch.truths, self._scenario.robots)
        self._misfits += misfits
        self._gaps.take(batch.truths)
        if len(track):
            self._live = frozenset(track.alive[-1].nonzero()[0].tolist())
            self._now = (int(track.ticks[-1]), float(track.t[-1]))
        self._watch.hear(batch.beliefs)
        self._board.add(batch.beliefs)
        yield from self._fields.rows(batch.fields)
        yield from self._graph.rows(track)
        yield from self._bodies.rows(track)
        yield from self._thoughts.rows(self._board.rows(self._live, all_of_them=last), track)
        yield from self._maps.rows(batch.maps, self._live, last=last)
        happened = batch.events + [
            Event(h.tick, self._time_of(h.tick), -1, f"halt: {h.reason}") for h in batch.halts
        ]
        if last:
            happened += self._losses()
        yield from events.log(happened)
        if batch.outcomes:
            yield from events.document(self._run, self._scenario, batch.outcomes[-1])

    def _time_of(self, tick: int) -> float:
        return tick * self._scenario.timing.tick

    def _losses(self) -> list[Event]:
        tick, t = self._now
        losses = []
        if self._gaps.lost:
            losses.append(f"{self._gaps.lost} of {self._gaps.sent} truth messages were lost")
        if self._misfits:
            losses.append(
                f"{self._misfits} truth messages did not fit {self._scenario.robots} robots and were lost"
            )
        if self._board.late:
            losses.append(f"{self._board.late} beliefs came too late to be drawn and were lost")
        return [Event(tick, t, -1, text) for text in losses]
