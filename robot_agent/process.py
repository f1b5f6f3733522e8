"""A robot as a process: `python -m robot_agent`, or `odourswarm robot`.

Rules: this shell owns the wires and waits; what the robot thinks is in `Agent`, how it keeps in step in `RobotSession`.
Every wait ends when the world or the neighbour waited for is gone, or when it takes too long.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import msgspec

from protocol import keys
from protocol.bus import Bus, Delivery, Lost, Seen
from protocol.errors import ScenarioError, SwarmFailure
from protocol.history.file import Histories, HistoryFolder
from protocol.messages import Answer, Ask, Belief, BeliefMap, Drive, Halt, Join, Reading, Resume, Shared, Stopped
from protocol.scenario import RobotScenario, lease_ms
from protocol.scenario.place import RobotPlace
from protocol.shell import settle_memory
from protocol.zenoh_bus import ZenohBus, token_of
from robot_agent.agent import Agent
from robot_agent.history import RobotHistory
from robot_agent.links import Links
from robot_agent.realtime import RealtimePart, realtime_session
from robot_agent.realtime_session import RealtimeRobotSession
from robot_agent.report import report
from robot_agent.session import RobotSession
from robot_agent.wiring import Wires, wire

LINK_POLL = 0.01  # s between two looks at the links while the swarm comes up
ASK_TIMEOUT = 2.0  # s for one query
FAREWELL = 2.0  # s that a robot waits for the world to close after its report
WORLD_BACK = 3.0  # s that a robot waits for a world that is gone: perhaps it was the robot that stood still


def ask_place(run: str, robot: int, world: str, timeout: float) -> RobotPlace:
    """Ask the world at endpoint `world` what robot `robot` may know and where its neighbours are."""
    bus = ZenohBus(run, f"guest/{robot}", token_of(run), listen=(), connect=(world,))
    try:
        deadline = time.monotonic() + timeout
        while time.monotonic() < deadline:
            answer = bus.ask(keys.SCENARIO, Ask(robot), ASK_TIMEOUT)
            if isinstance(answer, Answer):
                if not answer.ok:
                    raise ScenarioError(answer.text)
                return msgspec.json.decode(answer.text, type=RobotPlace)
            time.sleep(LINK_POLL)
    finally:
        bus.close()
    raise SwarmFailure(
        f"no world of run {run!r} answered at {world} within {timeout:g} s; start it first with `odourswarm world`."
    )


@dataclass(slots=True)
class RobotProcess:
    """One robot on the wires, from its first link to its last word."""

    run: str
    place: RobotPlace
    history: Path | None = None  # folder to write the history into
    say: Callable[[str], None] = lambda _: None
    rejoin: bool = False  # the run has begun: this process takes the place of one that ended

    def serve(self) -> None:
        """Join the run, take part until the world halts it, leave.

        Raises:
            SwarmFailure: the swarm did not link up, or the world is gone.
        """
        view = self.place.scenario
        me = keys.robot_name(view.robot)
        lower = [j for j in view.linked if j < view.robot]
        connect = (self.place.world, *(self.place.robots[j] for j in lower))
        bus = ZenohBus(
            self.run,
            me,
            token_of(self.run),
            listen=(self.place.robots[view.robot],),
            connect=connect,
            lease_ms=lease_ms(view.network, view.robots, view.clock),
            lockstep=view.clock == "lockstep",
        )
        histories = HistoryFolder(self.history) if self.history is not None else None
        try:
            session, wires = self._prepare(bus, view, histories)
            if self.rejoin:
                self._come_again(bus, view)
            else:
                self._link_up(bus, view)
            if isinstance(session, RealtimeRobotSession):
                sender = {keys.robot(j, keys.SHARED): j for j, _ in view.row}
                RealtimePart(bus, session, sender, wires.report, view.realtime.alone, self.say).take_part()
            else:
                self._take_part(bus, session, wires)
        finally:
            bus.close()
            if histories is not None:
                histories.close()

    def _prepare(
        self, bus: Bus, view: RobotScenario, histories: Histories | None
    ) -> tuple[RobotSession | RealtimeRobotSession, Wires]:
        wires = wire(bus, view)
        agent = Agent(view)
        if histories is not None:
            RobotHistory(agent, self.run, histories.member(keys.robot_name(view.robot)))
        belief = keys.robot(view.robot, keys.BELIEF)
        picture = keys.robot(view.robot, keys.MAP)
        tell, show = (bus.publisher(key, reliable=False) for key in (belief, picture))
        watched = _Watched(bus, agent, belief, picture, tell, show, wires.drive)
        if view.clock == "realtime":
            return realtime_session(agent, view, wires.tell, watched.drive), wires
        return RobotSession(agent, wires.tell, watched.drive), wires

    def _link_up(self, bus: Bus, view: RobotScenario) -> None:
        """Wait until the declared links are the actual ones and say so to the world."""
        declared = {keys.WORLD, *(keys.robot_name(j) for j in view.linked)}
        listeners = [keys.robot_name(j) for j in view.linked]
        deadline = time.monotonic() + view.network.join_timeout
        while True:
            actual = bus.links()
            linked = {name for name in actual if name == keys.WORLD or keys.robot_of(name) is not None}
            ready = bus.matched(keys.robot(view.robot, keys.DRIVE), (keys.WORLD,)) and (
                not listeners or bus.matched(keys.robot(view.robot, keys.SHARED), listeners)
            )
            if linked == declared and ready:
                links = tuple(sorted(j for name in linked if (j := keys.robot_of(name)) is not None))
                answer = bus.ask(keys.robot(view.robot, keys.JOIN), Join(view.robot, links), ASK_TIMEOUT)
                if isinstance(answer, Answer):
                    if answer.ok:
                        return
                    raise SwarmFailure(f"robot {view.robot}: the world refuses to let it join: {answer.text}")
            if time.monotonic() > deadline:
                missing, extra = sorted(declared - linked), sorted(linked - declared)
                raise SwarmFailure(
                    f"robot {view.robot}: after {view.network.join_timeout:g} s its links differ from the graph: "
                    f"missing {', '.join(missing) or 'none'}, undeclared {', '.join(extra) or 'none'}."
                )
            time.sleep(LINK_POLL)

    def _come_again(self, bus: Bus, view: RobotScenario) -> None:
        """Wait until the world is there and say so to it; it calls this robot when both ends see its links."""
        deadline = time.monotonic() + view.network.join_timeout
        while not bus.matched(keys.robot(view.robot, keys.DRIVE), (keys.WORLD,)):
            if time.monotonic() > deadline:
                raise SwarmFailure(f"robot {view.robot}: the world is gone, nothing to take part in again.")
            time.sleep(LINK_POLL)
        links = tuple(sorted(j for name in bus.links() if (j := keys.robot_of(name)) in view.linked and j is not None))
        answer = bus.ask(keys.robot(view.robot, keys.JOIN), Join(view.robot, links), max(0.0, deadline - time.monotonic()))
        if not isinstance(answer, Answer) or not answer.ok:
            why = answer.text if isinstance(answer, Answer) else "it does not answer."
            raise SwarmFailure(f"robot {view.robot}: the world refuses to let it join again: {why}")

    def _take_part(self, bus: Bus, session: RobotSession, wires: Wires) -> None:
        halted = False
        world_gone: float | None = None  # since when, s
        view = self.place.scenario
        # A process that takes the place of another waits until it sees its neighbours; the others have seen them.
        links = Links(session, () if self.rejoin else view.linked, wires.linked)
        for j in view.linked if self.rejoin else ():
            session.lose(j)
        patience = view.supervision.world_within if view.supervision.checkpoint_every else WORLD_BACK
        sender = {keys.robot(j, keys.SHARED): j for j, _ in self.place.scenario.row}
        settle_memory()
        while True:
            event = bus.receive(FAREWELL if halted else None if world_gone is None else patience)
            if isinstance(event, Delivery):
                message = event.message
                if isinstance(message, Shared):
                    if sender[event.key] == message.robot:
                        session.take_shared(message)
                    else:
                        bus.counters.refused += 1
                elif isinstance(message, Reading):
                    session.take_reading(message)
                elif isinstance(message, Resume):
                    links.resume(message)
                elif isinstance(message, Stopped):
                    (session.lose if message.stopped else session.see)(message.robot)
                elif isinstance(message, Halt) and not halted:
                    halted = True
                    self.say(f"the run is over: {message.reason}")
                    wires.report(report(session, bus.counters))
            elif isinstance(event, Lost):
                if event.name == keys.WORLD:
                    if halted:
                        return
                    world_gone = time.monotonic()
                elif (lost := keys.robot_of(event.name)) is not None:
                    links.lost(lost)
            elif isinstance(event, Seen):
                if event.name == keys.WORLD and world_gone is not None:
                    world_gone = None
                    links.say()
                elif (seen := keys.robot_of(event.name)) is not None:
                    links.seen(seen)
            elif event is None and halted:
                return
            if world_gone is not None and time.monotonic() - world_gone >= patience:
                raise SwarmFailure(f"robot {session.agent.robot}: the world is gone at tick {session.tick}.")


@dataclass(slots=True)
class _Watched:
    """Sends the drive, and at every decision the belief, for whoever watches."""

    bus: Bus
    agent: Agent
    key: str
    map_key: str
    tell: Callable[[Belief], None]
    show: Callable[[BeliefMap], None]
    send: Callable[[Drive], None]

    def drive(self, drive: Drive) -> None:
        self.send(drive)
        # After the drive: the swarm does not wait for telemetry.
        if self.agent.decision_due and self.bus.matched(self.key, ()):
            links = tuple(sorted(j for name in self.bus.links() if (j := keys.robot_of(name)) is not None))
            self.tell(self.agent.belief(links, self.bus.counters.dropped, self.bus.counters.refused))
        if self.agent.decision_due and self.bus.matched(self.map_key, ()):
            picture = self.agent.belief_map()
            if picture is not None:
                self.show(picture)
