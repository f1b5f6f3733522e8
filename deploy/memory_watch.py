"""`odourswarm run --bus memory`: a run in one process, with the same progress, events and recording as over Zenoh."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from deploy.launch.watcher import Watcher
from deploy.memory_run import MemorySwarm, run_in_memory
from protocol.history.file import Histories, HistoryFolder
from protocol.keys import robot_of
from protocol.messages import Event, Message, Outcome, Progress
from protocol.scenario import Scenario
from world_server.telemetry import Telemetry

PROGRESS_PERIOD = 0.1  # wall-clock s
FLUSH_PERIOD = 0.5  # wall-clock s


def run_watched(
    run: str, scenario: Scenario, watcher: Watcher, record: Path | None, *, view: bool, history: Path | None = None
) -> Outcome:
    """Run in memory; record, and keep histories in a folder, when asked to."""
    histories = HistoryFolder(history) if history is not None else None
    try:
        return _run_watched(run, scenario, watcher, record, histories, view=view)
    finally:
        if histories is not None:
            histories.close()


def _run_watched(
    run: str, scenario: Scenario, watcher: Watcher, record: Path | None, histories: Histories | None, *, view: bool
) -> Outcome:
    if record is None and not view:
        return run_in_memory(scenario, run=run, tell=watcher.event, observe=_Progress(watcher), history=histories)
    from deploy.recorder import Recording

    recording = Recording(scenario, path=record, view=view, run=run)
    try:
        observer = _Recorded(_Progress(watcher), recording.take, recording.flush)

        def tell(event: Event) -> None:
            watcher.event(event)
            recording.take(event)

        outcome = run_in_memory(scenario, run=run, tell=tell, observe=observer, history=histories)
        recording.take(outcome)
        return outcome
    finally:
        recording.close()


class _Progress:
    """Tells the watcher how it goes, some ten times a second."""

    def __init__(self, watcher: Watcher) -> None:
        self._watcher = watcher
        self._next = 0.0

    def __call__(self, swarm: MemorySwarm) -> bool:
        now = time.perf_counter()
        if now >= self._next:
            self._next = now + PROGRESS_PERIOD
            world = swarm.session.world
            self._watcher.progress(
                Progress(world.tick, world.t, len(world.live), world.detections, world.closest)
            )
        return True


class _Recorded:
    """Gives the recording what the processes would publish."""

    def __init__(self, progress: _Progress, take: Callable[[Message], None], flush: Callable[[], None]) -> None:
        self._progress = progress
        self._take = take
        self._flush = flush
        self._next = time.perf_counter() + FLUSH_PERIOD
        self._telemetry: Telemetry | None = None

    def __call__(self, swarm: MemorySwarm) -> bool:
        if self._telemetry is None:
            self._telemetry = Telemetry(swarm.session.world, self._take, self._take)
        self._telemetry.tick(last=swarm.session.ended is not None)
        for robot in swarm.robots.values():
            agent = robot.session.agent
            if robot.alive and agent.decision_due:
                links = tuple(sorted(j for name in robot.bus.links() if (j := robot_of(name)) is not None))
                self._take(agent.belief(links, robot.session.dropped, robot.bus.counters.refused))
                if (picture := agent.belief_map()) is not None:
                    self._take(picture)
        if time.perf_counter() >= self._next:
            self._flush()
            self._next = time.perf_counter() + FLUSH_PERIOD
        return self._progress(swarm)
