"""A run over Zenoh on this machine: world, robots and recorder as processes, watched to their end.

Rules: the launcher decides nothing of the run; it starts the processes, passes on what the world says, and leaves
nothing behind: no process, no socket, no file, whichever way it ends.
"""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from deploy.hosts.seats import Seats
from deploy.launch.attend import Attendant
from deploy.launch.children import Children
from deploy.launch.members import Members
from deploy.launch.watcher import Watcher
from protocol import keys
from protocol.bus import Bus, Delivery
from protocol.endpoints import make_endpoints
from protocol.errors import SwarmFailure
from protocol.messages import Event, Inject, Outcome, Progress, Truth
from protocol.scenario import Scenario, lease_ms
from protocol.zenoh_bus import ZenohBus, token_of

FLUSH = 60.0  # s that the recorder may take to write what it holds after the run
LEAVE = 2.0  # s that the processes may take to leave after the outcome
INTERRUPT = 1.2  # s that the world and the recorder may take to end an interrupted run,
HURRY = 0.5  # s that whoever is left may take after that; all is over within 2 s


@dataclass(slots=True)
class SwarmRun:
    """One run over Zenoh."""

    run: str
    scenario: Scenario
    record: Path | None = None
    view: bool = False
    history: Path | None = None  # folder for the members' histories
    truth: Callable[[Truth], None] | None = None  # told of the robots as they are, as often as `recording` says; best effort
    children: Children | None = None  # while and after it runs
    checkpoint: Path | None = None  # folder for the world's checkpoints; none: the run's own
    seats: Seats | None = None  # who runs on which host; none: everybody on this machine

    def execute(self, watcher: Watcher) -> Outcome:
        """Start everything, watch it, clean up.

        Raises:
            SwarmFailure: a process failed, in one sentence.
            KeyboardInterrupt: after an interrupted run was ended and cleaned up.
        """
        # Short: a unix socket's path has room for about 100 bytes.
        folder = Path(tempfile.mkdtemp(prefix="odour-"))
        children = self.children = Children(folder)
        patience = LEAVE
        try:
            return self._execute(folder, children, watcher)
        except KeyboardInterrupt:
            patience = HURRY
            raise
        finally:
            children.end(patience)
            shutil.rmtree(folder, ignore_errors=True)

    def _execute(self, folder: Path, children: Children, watcher: Watcher) -> Outcome:
        scenario = self.scenario
        seated = self.seats.endpoints if self.seats is not None else ()
        endpoints = seated or scenario.network.endpoints or make_endpoints(scenario, folder)
        members = Members(
            self.run, scenario, endpoints, folder, children,
            self.seats, self.history, self.checkpoint, self.record, self.view,
        )  # fmt: skip
        recorded = members.recorded
        members.start_all()

        def again(name: str) -> None:
            members.start(name, again=True)

        lease = lease_ms(scenario.network, scenario.robots, scenario.clock)
        bus = ZenohBus(self.run, "launcher", token_of(self.run), listen=(), connect=(endpoints[0],), lease_ms=lease)
        try:
            bus.subscribe(keys.PROGRESS, Progress)
            bus.subscribe(keys.EVENTS, Event)
            bus.subscribe(keys.OUTCOME, Outcome)
            bus.subscribe(keys.INJECT, Inject)
            if self.truth is not None:
                bus.subscribe(keys.TRUTH, Truth)
            try:
                outcome = Attendant(bus, scenario, children, watcher, again, self.truth, self.seats).attend()
            except KeyboardInterrupt:
                self._interrupt(bus, children)
                raise
        finally:
            bus.close()
        if recorded and not children.wait(FLUSH, ["recorder"]):
            raise SwarmFailure(f"the recorder did not finish writing within {FLUSH:g} s; {self.record} holds a part.")
        children.wait(LEAVE)
        if recorded and children.failed(["recorder"]):
            words = children.members["recorder"].last_words()
            raise SwarmFailure(f"the recorder failed: {words or 'without a word'}")
        if recorded and (words := children.members["recorder"].last_words()):
            watcher.event(Event(outcome.ticks, outcome.time, -1, words))
        return outcome

    def _interrupt(self, bus: Bus, children: Children) -> None:
        """Let the world end the run and the recorder write what it has; all within two seconds."""
        deadline = time.monotonic() + INTERRUPT
        world = children.members[keys.WORLD]
        if world.status is None:
            world.process.terminate()
        while time.monotonic() < deadline and world.status is None:
            event = bus.receive(0.05)
            if isinstance(event, Delivery) and isinstance(event.message, Outcome):
                break
        children.wait(max(0.0, deadline - time.monotonic()), ["recorder"])
