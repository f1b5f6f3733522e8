"""A whole run in one process over `MemoryBus`: tests, sweeps, and `odourswarm run --bus memory`.

Rules: the same `World`, `Agent` and sessions as over Zenoh, linked by the same graph, so that the truth is the same bit
for bit. The clock on the wall is read only to report the speed.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from protocol import keys
from protocol.bus import Delivery, Lost, Seen
from protocol.errors import ScenarioError
from protocol.history.file import Histories
from protocol.memory_bus import MemoryBus, MemoryNetwork
from protocol.messages import Drive, Event, Halt, Inject, Linked, Outcome, Reading, Report, Resume, Shared
from protocol.scenario import Scenario, robot_view
from robot_agent.agent import Agent
from robot_agent.history import RobotHistory
from robot_agent.report import report
from robot_agent.session import RobotSession
from robot_agent.wiring import wire
from world_server.history import WorldHistory
from world_server.outcome import outcome
from world_server.session import CONTINUE, INTERRUPTED, KILL, WorldSession
from world_server.world import World


@dataclass(slots=True)
class _Robot:
    bus: MemoryBus
    session: RobotSession
    report: Callable[[Report], None]
    linked: Callable[[Linked], None]
    alive: bool = True

    def pump(self) -> None:
        """Handle everything that has arrived."""
        inbox, session = self.bus.inbox, self.session
        while inbox:
            event = inbox.popleft()
            if isinstance(event, Delivery):
                message = event.message
                if isinstance(message, Shared):
                    session.take_shared(message)
                elif isinstance(message, Reading):
                    session.take_reading(message)
                elif isinstance(message, Resume):
                    session.resume(message.tick)
                    self.linked(Linked(message.robot, message.tick, session.agent.scenario.linked))
                elif isinstance(message, Halt):
                    self.report(report(session, self.bus.counters))
            elif isinstance(event, Lost) and (lost := keys.robot_of(event.name)) is not None:
                session.lose(lost)
            elif isinstance(event, Seen) and (seen := keys.robot_of(event.name)) is not None:
                session.see(seen)


class MemorySwarm:
    """World and robots of one run in memory, stepped from outside; faults are injected between the steps."""

    def __init__(
        self,
        scenario: Scenario,
        *,
        wire: bool = False,
        tell: Callable[[Event], None] | None = None,
        history: Histories | None = None,
        run: str = "memory",
    ) -> None:
        if scenario.clock != "lockstep":
            raise ScenarioError(f'clock is "{scenario.clock}"; a run in memory has no wall clock, it must be "lockstep".')
        self.scenario = scenario
        self.run = run
        self._histories = history
        n = scenario.robots
        links = [(keys.WORLD, keys.robot_name(i)) for i in range(n)]
        links += sorted({(keys.robot_name(min(i, j)), keys.robot_name(max(i, j))) for i, j, _ in scenario.graph})
        self.network = MemoryNetwork(links, token=scenario.seed, wire=wire)
        self.bus = self.network.join(keys.WORLD)
        self.bus.subscribe("robot/*/drive", Drive)
        self.bus.subscribe("robot/*/report", Report)
        self.bus.subscribe("robot/*/linked", Linked)
        self.robots = {i: self._robot(i) for i in range(n)}
        send = {i: self.bus.publisher(keys.robot(i, keys.READING), reliable=True) for i in range(n)}
        resume = {i: self.bus.publisher(keys.robot(i, keys.RESUME), reliable=True) for i in range(n)}
        halt = self.bus.publisher(keys.HALT, reliable=True)
        world = World(scenario)
        self.history = WorldHistory(world, run, history.member(keys.WORLD)) if history else None
        if self.history is not None:
            halt = self.history.halting(halt)
        self.session = WorldSession(world, send, halt, tell or (lambda _: None), resume, self._inject)

    def _robot(self, i: int) -> _Robot:
        view = robot_view(self.scenario, i)
        bus = self.network.join(keys.robot_name(i))
        wires = wire(bus, view)
        agent = Agent(view)
        if self._histories is not None:
            RobotHistory(agent, self.run, self._histories.member(keys.robot_name(i)))
        return _Robot(bus, RobotSession(agent, wires.tell, wires.drive), wires.report, wires.linked)

    def start(self) -> None:
        """Send the first readings."""
        self.session.start()

    def tick(self) -> None:
        """Let everyone handle what has arrived until the world has stepped once or the run is over."""
        before = self.session.world.tick
        while self.session.world.tick == before and not self.session.over:
            for robot in self.robots.values():
                if robot.alive:
                    robot.pump()
            if not self._pump_world():
                return

    def kill(self, i: int) -> None:
        """End robot `i` as SIGKILL would."""
        self.robots[i].alive = False
        self.network.kill(keys.robot_name(i))

    def restart(self, i: int) -> None:
        """Begin robot `i`, which was killed, anew; it takes part when the world has called it."""
        self.robots[i] = self._robot(i)

    def _inject(self, inject: Inject) -> None:
        """A planned crash ends the robot, its return begins a new one; one that hangs is only not spoken to."""
        if inject.action == KILL:
            self.kill(inject.robot)
        elif inject.action == CONTINUE and not self.robots[inject.robot].alive:
            self.restart(inject.robot)

    def _pump_world(self) -> bool:
        """Handle what has arrived at the world; whether anything had."""
        session, inbox = self.session, self.bus.inbox
        any_event = bool(inbox) or session.idle
        while inbox:
            event = inbox.popleft()
            complete = False
            if isinstance(event, Delivery):
                message = event.message
                if isinstance(message, Drive):
                    complete = session.take_drive(message)
                elif isinstance(message, Report):
                    session.take_report(message)
                elif isinstance(message, Linked):
                    session.take_linked(message)
                    for robot in session.returned:
                        session.admit(robot)
            elif isinstance(event, Lost) and (lost := keys.robot_of(event.name)) is not None:
                complete = session.lose(lost)
            if complete:
                session.step()
        if session.idle:
            session.step()
        return any_event


def run_in_memory(
    scenario: Scenario,
    *,
    run: str = "memory",
    wire: bool = False,
    observe: Callable[[MemorySwarm], bool] | None = None,
    tell: Callable[[Event], None] | None = None,
    history: Histories | None = None,
) -> Outcome:
    """Run `scenario` to its end.

    Args:
        wire: send every message through the codec, as over Zenoh.
        observe: called after every tick; False ends the run as interrupted.
        tell: called with every event.
        history: where every member writes down what it did (`protocol.history.file`); the caller closes it.
    """
    swarm = MemorySwarm(scenario, wire=wire, tell=tell, history=history, run=run)
    session = swarm.session
    start = time.perf_counter()
    swarm.start()
    while not session.over:
        swarm.tick()
        if observe is not None and not observe(swarm):
            session.end(INTERRUPTED)
    ended = outcome(session, run, time.perf_counter() - start, swarm.bus.counters)
    if swarm.history is not None:
        swarm.history.result(ended)
    return ended
