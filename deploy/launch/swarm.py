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

import msgspec

from deploy.hosts.seats import Seats
from deploy.launch.children import Children
from deploy.launch.injector import Injector
from deploy.launch.members import Members
from deploy.launch.standstill import Standstill
from deploy.launch.supervisor import Supervisor
from deploy.launch.watcher import Watcher
from protocol import keys
from protocol.bus import Bus, Delivery, Lost
from protocol.endpoints import make_endpoints
from protocol.errors import SwarmFailure
from protocol.messages import Event, Inject, Outcome, Progress, Truth
from protocol.scenario import Scenario, lease_ms
from protocol.zenoh_bus import ZenohBus, token_of

POLL = 0.1  # s between two looks at the processes
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
                outcome = self._watch(bus, children, watcher, again)
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

    def _watch(self, bus: Bus, children: Children, watcher: Watcher, again: Callable[[str], None]) -> Outcome:
        begun = False
        silent_since: float | None = None  # when the world's liveliness was lost, without its process having ended
        injector = Injector(children)
        # In real time the world finds out of itself that a robot hangs as planned; in lock-step it knows.
        planned = injector.stopped if self.scenario.clock == "lockstep" else ()
        standstill = Standstill(children, bus.publisher(keys.STOPPED, reliable=True), planned)
        tick, t = 0, 0.0
        started = time.monotonic()
        supervisor = Supervisor(
            self.scenario, children, again, lambda robot, text: watcher.event(Event(tick, t, robot, text))
        )
        while True:
            event = bus.receive(POLL)
            if isinstance(event, Delivery):
                message = event.message
                if isinstance(message, Outcome):
                    injector.end()
                    return message
                if isinstance(message, Inject):
                    if message.action == "kill":
                        supervisor.planned(message)
                    injector.do(message)
                if isinstance(message, Progress):
                    if not begun:
                        injector.refuse_beyond_reach(self.scenario)
                    begun = True
                    tick, t = message.tick, message.t
                    watcher.progress(message)
                elif isinstance(message, Event):
                    watcher.event(message)
                elif isinstance(message, Truth) and self.truth is not None:
                    self.truth(message)
            if begun and (event is None or not isinstance(event, Delivery) or isinstance(event.message, Event | Inject)):
                supervisor.look(time.monotonic())
            if begun:
                standstill.look(time.monotonic())
            if isinstance(event, Lost) and event.name == keys.WORLD:
                silent_since = time.monotonic()
            elif event is not None and not isinstance(event, Lost):
                silent_since = None
            if silent_since is not None and time.monotonic() - silent_since > self.scenario.network.return_timeout:
                silent_since = None
                self._end_hung_world(children, restarted=begun and supervisor.keeps_world)
            if event is None and not begun:
                self._refuse_unreachable(bus, time.monotonic() - started)
            if event is None or isinstance(event, Lost):
                if (outcome := self._left_behind(children)) is not None:
                    injector.end()
                    return outcome
                if not (begun and supervisor.keeps_world):
                    self._look_after(children, begun)

    def _left_behind(self, children: Children) -> Outcome | None:
        """What a world that has ended well wrote down, for whom the link to it was down when it told the outcome."""
        if children.members[keys.WORLD].status != 0:
            return None
        try:
            return msgspec.json.decode((children.folder / "outcome.json").read_bytes(), type=Outcome)
        except FileNotFoundError:
            return None

    def _refuse_unreachable(self, bus: Bus, waited: float) -> None:
        """A world on another host may be out of reach while its process there, and the command to it, live."""
        patience = self.scenario.network.join_timeout
        if self.seats is not None and waited > patience and keys.WORLD not in bus.links():
            raise SwarmFailure(
                f"no world answers at {self.seats.endpoints[0]} within {patience:g} s; look whether its command gets "
                f"through to that host, and whether this one reaches the address."
            )

    def _end_hung_world(self, children: Children, *, restarted: bool) -> None:
        """The world's process is there and says nothing: end it, so that the supervisor starts it again, or the run."""
        world = children.members[keys.WORLD]
        if world.status is not None:
            return
        world.process.kill()
        if not restarted:
            seconds = self.scenario.network.return_timeout
            raise SwarmFailure(f"the world hangs: nothing was heard of it for {seconds:g} s.")

    def _look_after(self, children: Children, begun: bool) -> None:
        """Notice what cannot be mended: the world is gone, or somebody is before the run began."""
        failed = children.failed([keys.WORLD] if begun else None)
        if children.members[keys.WORLD].status is not None and not failed:
            raise SwarmFailure("the world ended without an outcome.")
        if failed:
            # When one fails the others do in consequence, and say that somebody is gone or missing: the cause is another.
            consequences = ("is gone", "is not complete")
            told = [c for c in failed if not any(text in c.last_words() for text in consequences)]
            child = (told or sorted(failed, key=lambda c: c.name != keys.WORLD))[0]
            how = f"status {child.status}" if (child.status or 0) > 0 else f"signal {-(child.status or 0)}"
            raise SwarmFailure(f"{child.name} ended with {how}: {child.last_words() or 'it said nothing.'}")

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
