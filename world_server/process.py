"""The world as a process: `python -m world_server`, or `odourswarm world`.

Rules: this shell owns the wires, the wall clock and waits; the truth is in `World`, the barrier in `WorldSession`. Every
wait ends when the robot waited for is gone, or when it takes too long.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import msgspec

from protocol import keys
from protocol.bus import Asked, Bus, Delivery, Lost, Seen
from protocol.errors import SwarmFailure
from protocol.history.file import Histories, HistoryFolder
from protocol.messages import Answer, Ask, Drive, Halt, Join, Linked, Outcome, Report, Stopped
from protocol.scenario import Scenario, lease_ms, scenario_digest
from protocol.scenario.faults import Crash, Hang
from protocol.scenario.place import place_of
from protocol.shell import Stop
from protocol.zenoh_bus import ZenohBus, token_of
from world_server.checkpoints import Checkpoints, Saved
from world_server.comeback import gather_again
from world_server.history import WorldHistory
from world_server.lockstep import LockstepWorld
from world_server.outcome import outcome
from world_server.realtime import RealtimeWorld
from world_server.realtime_session import RealtimeWorldSession
from world_server.recoverable import RecoverableSession
from world_server.returns import Returns
from world_server.session import INTERRUPTED, WorldSession
from world_server.telemetry import Telemetry
from world_server.world import World

POLL = 0.02  # s between two looks at what is not an event
LAST_WORDS = 1.0  # s that the world waits for the robots' reports
FAREWELL = 2.0  # s that the world stays at most for the outcome to be taken


@dataclass(slots=True)
class WorldProcess:
    """The world on the wires, from its endpoint to the outcome."""

    run: str
    scenario: Scenario
    endpoints: tuple[str, ...]  # the world's, then each robot's
    recorder: bool = False  # wait for a recorder before the start
    launcher: bool = False  # wait for a launcher before the start, and for it to take the outcome
    history: Path | None = None  # folder to write the history into
    say: Callable[[str], None] = lambda _: None
    checkpoints: Path | None = None  # folder for checkpoints; one of this run that is there is gone on from

    def serve(self) -> Outcome:
        """Bring the swarm up, run it to its end; how it ended.

        Raises:
            SwarmFailure: the swarm did not link up.
            Stop: told to stop before the first tick.
        """
        bus = ZenohBus(
            self.run,
            keys.WORLD,
            token_of(self.run),
            listen=(self.endpoints[0],),
            connect=(),
            lease_ms=lease_ms(self.scenario.network, self.scenario.robots, self.scenario.clock),
            lockstep=self.scenario.clock == "lockstep",
        )
        histories = HistoryFolder(self.history) if self.history is not None else None
        kept = Checkpoints(self.checkpoints, self.run, scenario_digest(self.scenario)) if self.checkpoints else None
        over = False
        try:
            ended = self._serve(bus, histories, kept)
            over = True
            return ended
        finally:
            bus.close()
            if histories is not None:
                histories.close()
            if kept is not None:
                kept.close(remove=over)

    def _serve(self, bus: Bus, histories: Histories | None, kept: Checkpoints | None) -> Outcome:
        self._listen(bus)
        returns = Returns(self.scenario, bus.publisher(keys.INJECT, reliable=True) if self.launcher else None)
        halt = bus.publisher(keys.HALT, reliable=True)
        truth, field = (bus.publisher(key, reliable=False) for key in (keys.TRUTH, keys.FIELD))
        progress = bus.publisher(keys.PROGRESS, reliable=False)
        pass_on = bus.publisher(keys.STOPPED, reliable=True)
        result = bus.publisher(keys.OUTCOME, reliable=True)

        # The robots link up among themselves while the plume is warmed up here.
        history: WorldHistory | None = None

        def end(message: Halt) -> None:
            (halt if history is None else history.halting(halt))(message)

        saved = kept.load() if kept is not None else None
        session = self._session(bus, end, returns, kept, saved)
        world = session.world
        if histories is not None:  # not before: what a world that came back lived through again is written already
            history = WorldHistory(world, self.run, histories.member(keys.WORLD))
        if isinstance(session, RecoverableSession) and saved is not None:
            members = [m for m, wanted in (("recorder", self.recorder), ("launcher", self.launcher)) if wanted]
            gather_again(bus, session, members, self._answer_late, self.scenario.network.return_timeout)
        else:
            self._gather(bus)
            if isinstance(session, RecoverableSession) and kept is not None:
                kept.write(0, world.snapshot(), session.snapshot(), 0.0)
        # Whoever listens for the truth, the recorder or the launcher, is there by now.
        watched = self.recorder or bus.matched(keys.TRUTH, ())
        telemetry = Telemetry(world, truth, field) if watched else None
        planned = any(isinstance(fault, Crash | Hang) for fault in self.scenario.faults)
        if planned and not self.launcher and isinstance(session, RecoverableSession):
            session.tell("no launcher: robots that crash or hang as planned are only left out of the run")
        start = time.perf_counter() - (saved[0].wall_s if saved is not None else 0.0)
        try:
            if isinstance(session, RealtimeWorldSession):
                RealtimeWorld(bus, session, telemetry, progress, pass_on, self._answer_late, self.launcher).run()
            else:
                LockstepWorld(bus, session, telemetry, progress, pass_on, returns, kept, start, self._answer_late).run()
        except Stop:
            session.end(INTERRUPTED)
        wall_s = time.perf_counter() - start
        if telemetry is not None:
            telemetry.tick(last=True)
        self._collect_reports(bus, session)
        ended = outcome(session, self.run, wall_s, bus.counters)
        if history is not None:
            history.result(ended)
        result(ended)
        self._farewell(bus)
        return ended

    def _listen(self, bus: Bus) -> None:
        for i in range(self.scenario.robots):
            bus.subscribe(keys.robot(i, keys.DRIVE), Drive)
            bus.subscribe(keys.robot(i, keys.REPORT), Report)
            bus.subscribe(keys.robot(i, keys.LINKED), Linked)
        if self.launcher:
            bus.subscribe(keys.STOPPED, Stopped)
        bus.serve(keys.SCENARIO, Ask)
        bus.serve("robot/*/join", Join)

    def _session(
        self, bus: Bus, halt: Callable[[Halt], None], returns: Returns, kept: Checkpoints | None, saved: Saved | None
    ) -> RecoverableSession | RealtimeWorldSession:
        """The world and its session: new, or as they were `saved`."""
        scenario, robots = self.scenario, range(self.scenario.robots)
        lockstep = scenario.clock == "lockstep"
        send = {i: bus.publisher(keys.robot(i, keys.READING), reliable=lockstep) for i in robots}
        resume = {i: bus.publisher(keys.robot(i, keys.RESUME), reliable=True) for i in robots}
        tell = bus.publisher(keys.EVENTS, reliable=False)
        world = World(scenario) if saved is None else World.restore(scenario, saved[0].world)
        if not lockstep:
            return RealtimeWorldSession(world, send, halt, tell, resume, returns.inject)
        journal = kept.note if kept is not None else lambda _: None
        patient = scenario.supervision.restart != "never"
        session = RecoverableSession(world, send, halt, tell, resume, returns.inject, journal, patient=patient)
        if saved is not None:
            session.restore(saved[0].session, saved[1])
        return session

    def _gather(self, bus: Bus) -> None:
        """Wait until every robot has joined and every publication has its subscriber."""
        scenario = self.scenario
        waiting = set(range(scenario.robots))
        gone: set[str] = set()
        members = {name for name, wanted in (("recorder", self.recorder), ("launcher", self.launcher)) if wanted}
        deadline = time.monotonic() + scenario.network.join_timeout
        while True:
            event = bus.receive(POLL)
            if isinstance(event, Asked):
                self._answer(event, waiting)
            elif isinstance(event, Seen):
                members.discard(event.name)
                gone.discard(event.name)
            elif isinstance(event, Lost) and keys.robot_of(event.name) is not None:
                # It may only have been held up while everybody starts, and come back.
                gone.add(event.name)
            elif event is None and not waiting and not members and not gone and self._all_matched(bus):
                return
            if time.monotonic() > deadline:
                missing = [keys.robot_name(i) for i in sorted(waiting)] + sorted(members | gone)
                raise SwarmFailure(
                    f"after {scenario.network.join_timeout:g} s the swarm is not complete: "
                    f"missing {', '.join(missing) or 'a subscriber of some reading'}."
                )

    def _all_matched(self, bus: Bus) -> bool:
        return all(
            bus.matched(keys.robot(i, keys.READING), (keys.robot_name(i),)) for i in range(self.scenario.robots)
        )

    def _answer(self, asked: Asked, waiting: set[int] | None) -> None:
        message = asked.message
        if isinstance(message, Ask):
            asked.answer(self._place(message.robot))
        elif isinstance(message, Join):
            i = message.robot
            if keys.robot_of(asked.key) != i or not 0 <= i < self.scenario.robots:
                asked.answer(Answer(False, f"there is no robot {i}: this run has 0 to {self.scenario.robots - 1}."))
                return
            declared = place_of(self.scenario, i, self.endpoints).scenario.linked
            if message.links != declared if waiting is not None else not set(declared).issuperset(message.links):
                asked.answer(Answer(False, f"its links {message.links} are not the declared ones {declared}."))
                return
            if waiting is not None:
                waiting.discard(i)
            asked.answer(Answer(True, ""))

    def _answer_late(self, asked: Asked) -> None:
        """Of a robot that joins a run that has begun the links are looked at when it is called."""
        self._answer(asked, None)

    def _place(self, i: int) -> Answer:
        if not 0 <= i < self.scenario.robots:
            return Answer(False, f"there is no robot {i}: this run has robots 0 to {self.scenario.robots - 1}.")
        return Answer(True, msgspec.json.encode(place_of(self.scenario, i, self.endpoints)).decode())

    def _collect_reports(self, bus: Bus, session: WorldSession) -> None:
        deadline = time.monotonic() + LAST_WORDS
        while not session.over and (left := deadline - time.monotonic()) > 0:
            event = bus.receive(left)
            if isinstance(event, Delivery) and isinstance(event.message, Report):
                if keys.robot_of(event.key) == event.message.robot:
                    session.take_report(event.message)
            elif isinstance(event, Lost) and (lost := keys.robot_of(event.name)) is not None:
                session.lose(lost)

    def _farewell(self, bus: Bus) -> None:
        """Stay until launcher and recorder have gone, or a moment if they stay."""
        waited_for = {name for name, wanted in (("recorder", self.recorder), ("launcher", self.launcher)) if wanted}
        deadline = time.monotonic() + FAREWELL
        while waited_for and (left := deadline - time.monotonic()) > 0:
            event = bus.receive(left)
            if isinstance(event, Lost):
                waited_for.discard(event.name)
