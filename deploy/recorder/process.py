"""The recorder as a process: linked to the world and to every robot, in nobody's way.

Rules: it is ready, Rerun loaded and the file open, before the run begins; from then on it takes a low priority, and what
it is sent is best effort, so that the swarm's speed does not depend on it. It writes twice a second, so that a kill
leaves what was written.
"""

from __future__ import annotations

import contextlib
import os
import time
from dataclasses import dataclass
from pathlib import Path

from deploy.recorder.recording import Recording
from protocol import keys
from protocol.bus import Bus, Delivery, Lost, Seen
from protocol.errors import SwarmFailure
from protocol.messages import Belief, BeliefMap, Event, Field, Halt, Outcome, Truth
from protocol.scenario import Scenario, lease_ms
from protocol.shell import Stop, ignore_signals
from protocol.zenoh_bus import ZenohBus, token_of

FLUSH_PERIOD = 0.5  # wall-clock s
NICE = 5  # enough to let the swarm go first, and not so much that a busy machine never draws


@dataclass(slots=True)
class RecorderProcess:
    """The recorder on the wires, from its first link to the closed file."""

    run: str
    scenario: Scenario
    endpoints: tuple[str, ...]  # the world's, then each robot's
    record: Path | None
    view: bool

    def serve(self) -> None:
        """Record until the world has told the outcome or is gone.

        Raises:
            OdourswarmError: the recording cannot be written.
            SwarmFailure: the world was gone before the run began.
        """
        bus = ZenohBus(
            self.run,
            "recorder",
            token_of(self.run),
            listen=(),
            connect=self.endpoints,
            lease_ms=lease_ms(self.scenario.network, self.scenario.robots, self.scenario.clock),
        )
        try:
            for key, kind in (
                (keys.TRUTH, Truth),
                (keys.FIELD, Field),
                (keys.EVENTS, Event),
                (keys.OUTCOME, Outcome),
            ):
                bus.subscribe(key, kind)
            bus.subscribe(keys.HALT, Halt)
            for i in range(self.scenario.robots):
                bus.subscribe(keys.robot(i, keys.BELIEF), Belief)
                bus.subscribe(keys.robot(i, keys.MAP), BeliefMap)
            recording = Recording(self.scenario, path=self.record, view=self.view, run=self.run)
            with contextlib.suppress(OSError, AttributeError):  # Windows has no nice
                os.nice(NICE)  # this thread, which draws; those that receive have started already
            try:
                # The first `receive` announces the recorder; the world waits for that.
                self._listen(bus, recording)
            finally:
                ignore_signals()
                recording.close()
        finally:
            bus.close()

    def _listen(self, bus: Bus, recording: Recording) -> None:
        next_flush = time.monotonic() + FLUSH_PERIOD
        supervision = self.scenario.supervision
        patience = supervision.world_within if supervision.checkpoint_every else 0.0  # a world may come back
        gone: float | None = None  # since when the world is, s
        try:
            while True:
                event = bus.receive(max(0.0, next_flush - time.monotonic()))
                if isinstance(event, Delivery):
                    recording.take(event.message)
                    if isinstance(event.message, Outcome):
                        return
                elif isinstance(event, Lost) and event.name == keys.WORLD:
                    gone = time.monotonic()
                elif isinstance(event, Seen) and event.name == keys.WORLD:
                    gone = None
                if gone is not None and time.monotonic() - gone >= patience:
                    raise SwarmFailure("the world is gone; the recording holds what was heard until then.")
                if time.monotonic() >= next_flush:
                    recording.flush()
                    next_flush = time.monotonic() + FLUSH_PERIOD
        except Stop:
            return
