"""What the launcher does while a run goes on: it listens to the world, and looks after the processes.

Rules: it decides nothing of the run. It ends with the world's outcome, or with a sentence that says why there is none; no
wait is longer than POLL without a look at the processes.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field

import msgspec

from deploy.hosts.seats import Seats
from deploy.launch.children import Children
from deploy.launch.injector import Injector
from deploy.launch.standstill import Standstill
from deploy.launch.supervisor import Supervisor
from deploy.launch.watcher import Watcher
from protocol import keys
from protocol.bus import Bus, BusEvent, Delivery, Lost
from protocol.errors import SwarmFailure
from protocol.messages import Event, Inject, Message, Outcome, Progress, Truth
from protocol.scenario import Scenario

POLL = 0.1  # s between two looks at the processes


@dataclass(slots=True)
class Attendant:
    """Of one run, from the start of its processes to its outcome."""

    bus: Bus
    scenario: Scenario
    children: Children
    watcher: Watcher
    again: Callable[[str], None]  # starts a member again
    truth: Callable[[Truth], None] | None = None
    seats: Seats | None = None
    _injector: Injector = field(init=False)
    _standstill: Standstill = field(init=False)
    _supervisor: Supervisor = field(init=False)
    _begun: bool = False
    _at: tuple[int, float] = (0, 0.0)  # tick and s, as the world told last
    _next: float = 0.0  # when the processes are to be looked at
    _silent_since: float | None = None  # when the world's liveliness was lost, without its process having ended

    def __post_init__(self) -> None:
        self._injector = Injector(self.children)
        # In real time the world finds out of itself that a robot hangs as planned; in lock-step it knows.
        planned = self._injector.stopped if self.scenario.clock == "lockstep" else ()
        self._standstill = Standstill(self.children, self.bus.publisher(keys.STOPPED, reliable=True), planned)
        self._supervisor = Supervisor(
            self.scenario, self.children, self.again, lambda robot, text: self.watcher.event(Event(*self._at, robot, text))
        )

    def attend(self) -> Outcome:
        """The outcome, when the run has one.

        Raises: SwarmFailure when it will have none.
        """
        began = time.monotonic()
        while True:
            event = self.bus.receive(POLL)
            outcome = self._hear(event.message) if isinstance(event, Delivery) else None
            now = time.monotonic()
            if outcome is None:
                self._look(event, now)
                if event is None and not self._begun:
                    self._refuse_unreachable(now - began)
                if event is None or isinstance(event, Lost):
                    outcome = self._left_behind()
            if outcome is not None:
                self._injector.end()
                return outcome
            if (event is None or isinstance(event, Lost)) and not (self._begun and self._supervisor.keeps_world):
                self._look_after()

    def _hear(self, message: Message) -> Outcome | None:
        """Do what a message asks for; the outcome, if it is that."""
        if isinstance(message, Outcome):
            return message
        if isinstance(message, Inject):
            if message.action == "kill":
                self._supervisor.planned(message)
            self._injector.do(message)
        elif isinstance(message, Progress):
            if not self._begun:
                self._injector.refuse_beyond_reach(self.scenario)
            self._begun, self._at = True, (message.tick, message.t)
            self.watcher.progress(message)
        elif isinstance(message, Event):
            self.watcher.event(message)
        elif isinstance(message, Truth) and self.truth is not None:
            self.truth(message)
        return None

    def _look(self, event: BusEvent | None, now: float) -> None:
        """Look at the processes: who has ended, who stands still, whether the world says anything."""
        if self._begun:
            # Also while one message follows the other: somebody may be due to be started again.
            if (isinstance(event, Delivery) and isinstance(event.message, Event | Inject)) or now >= self._next:
                self._next = now + POLL
                self._supervisor.look(now)
            self._standstill.look(now)
        if isinstance(event, Lost) and event.name == keys.WORLD:
            self._silent_since = now
        elif event is not None and not isinstance(event, Lost):
            self._silent_since = None
        if self._silent_since is not None and now - self._silent_since > self.scenario.network.return_timeout:
            self._silent_since = None
            self._end_hung_world()

    def _left_behind(self) -> Outcome | None:
        """What a world that has ended well wrote down, for whom the link to it was down when it told the outcome."""
        if self.children.members[keys.WORLD].status != 0:
            return None
        try:
            return msgspec.json.decode((self.children.folder / "outcome.json").read_bytes(), type=Outcome)
        except FileNotFoundError:
            return None

    def _refuse_unreachable(self, waited: float) -> None:
        """A world on another host may be out of reach while its process there, and the command to it, live."""
        patience = self.scenario.network.join_timeout
        if self.seats is not None and waited > patience and keys.WORLD not in self.bus.links():
            raise SwarmFailure(
                f"no world answers at {self.seats.endpoints[0]} within {patience:g} s; look whether its command gets "
                f"through to that host, and whether this one reaches the address."
            )

    def _end_hung_world(self) -> None:
        """The world's process is there and says nothing: end it, so that the supervisor starts it again, or the run."""
        world = self.children.members[keys.WORLD]
        if world.status is not None:
            return
        world.process.kill()
        if not (self._begun and self._supervisor.keeps_world):
            seconds = self.scenario.network.return_timeout
            raise SwarmFailure(f"the world hangs: nothing was heard of it for {seconds:g} s.")

    def _look_after(self) -> None:
        """Notice what cannot be mended: the world is gone, or somebody is before the run began."""
        failed = self.children.failed([keys.WORLD] if self._begun else None)
        if self.children.members[keys.WORLD].status is not None and not failed:
            raise SwarmFailure("the world ended without an outcome.")
        if failed:
            # When one fails the others do in consequence, and say that somebody is gone or missing: the cause is another.
            consequences = ("is gone", "is not complete")
            told = [c for c in failed if not any(text in c.last_words() for text in consequences)]
            child = (told or sorted(failed, key=lambda c: c.name != keys.WORLD))[0]
            how = f"status {child.status}" if (child.status or 0) > 0 else f"signal {-(child.status or 0)}"
            raise SwarmFailure(f"{child.name} ended with {how}: {child.last_words() or 'it said nothing.'}")
