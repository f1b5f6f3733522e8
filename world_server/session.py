"""The world's side of lock-step: readings out, drives in, a barrier that nobody dead can hold up.

Rules: no clock, no socket; messages go in by `take_*` and out by the publications given at the start. The world steps
when all live robots have answered; a robot that is lost leaves the barrier at once and its body brakes. What is late,
early, double or from a robot that is not alive is counted and dropped.

Robots leave and enter at exact ticks, before anybody is told what it senses there: `suspend` takes one out; `call` asks
one to come back, and until it was let in (`admit`) or given up (`give_up`) the tick does not begin, so that the truth
does not depend on how long a process takes. The scenario's faults (`world_server.faults.plan`) say who and when; the
shell says when a called robot is there, from what the robots say of their links (`returned`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from protocol.messages import Drive, Event, Halt, Inject, Linked, Reading, Report, Resume
from world_server.declarations import Declarations
from world_server.faults.plan import CRASH, Due, Plan
from world_server.roster import Roster
from world_server.world import World

FOUND, DECLARED, TIME_OUT, INTERRUPTED = "found", "declared", "time out", "interrupted"
ALL_STOPPED = "all robots have stopped, as planned"
STOP, CONTINUE, KILL = "stop", "continue", "kill"  # what the launcher is asked to do to a process

_NOBODY: Mapping[int, Callable[[Resume], None]] = {}


class WorldSession:
    """Drives a `World` through the ticks of a run."""

    waits_for_returns = True  # False: who is called takes part at once, whether it is there or not (real time)

    def __init__(
        self,
        world: World,
        send: Mapping[int, Callable[[Reading], None]],
        halt: Callable[[Halt], None],
        tell: Callable[[Event], None],
        resume: Mapping[int, Callable[[Resume], None]] = _NOBODY,
        inject: Callable[[Inject], None] = lambda _: None,
    ) -> None:
        """`resume` reaches robots that do not take part; `inject` whoever can stop, continue and kill their processes."""
        self.world = world
        self.ended: str | None = None  # why the run is over
        self.reports: dict[int, Report] = {}
        self.dropped = 0
        self.faults: list[str] = []
        self._send = send
        self._halt = halt
        self._tell = tell
        self._drives: dict[int, Drive] = {}
        self._started = False
        self.plan = Plan(world.scenario)
        self.stopped: set[int] = set()  # robots that a planned fault keeps out
        self.awaited: set[int] = set()  # robots that were called and are not there yet
        self._resume = resume
        self._inject = inject
        self._roster = Roster(world.scenario)
        self.answered: set[int] = set()  # of the awaited ones, those that have answered
        self._by_word = world.scenario.declaration.stop == "declared"  # the swarm itself says when it is over
        self._reached = False
        self.declarations = Declarations()
        self._readings: list[Reading] = []  # of this tick

    @property
    def unanswered(self) -> list[int]:
        """Robots that take part and whose answers of this tick are missing."""
        return sorted(self.world.live - self._drives.keys())

    @property
    def over(self) -> bool:
        """Whether the run has ended and every live robot has said its last word."""
        return self.ended is not None and self.world.live <= self.reports.keys()

    @property
    def idle(self) -> bool:
        """Whether nobody takes part at present and the world is to step by itself, until somebody comes back."""
        return not self.world.live and not self.awaited and self._started and self.ended is None

    @property
    def returned(self) -> list[int]:
        """Awaited robots that have answered and whose links are back, as both ends of each say."""
        live = self.world.live
        return [i for i in sorted(self.awaited) if i in self.answered and self._roster.complete(i, live)]

    def start(self) -> None:
        """Send the readings of tick 0."""
        self._started = True
        self._begin()

    def take_drive(self, drive: Drive) -> bool:
        """Take a robot's answer; whether all live robots have answered now."""
        world = self.world
        if self.ended is not None or drive.tick != world.tick or drive.robot not in world.live:
            self.dropped += 1
            return False
        if drive.robot in self._drives:
            self.dropped += 1
            return False
        self._drives[drive.robot] = drive
        return len(self._drives) == len(world.live)

    def take_report(self, report: Report) -> None:
        """Take a robot's last word."""
        if self.ended is None or report.robot in self.reports or report.robot in self.stopped:
            self.dropped += 1
        else:
            self.reports[report.robot] = report

    def step(self) -> None:
        """All live robots have answered: move the world to the next tick, and say what the robots sense there."""
        world = self.world
        drives, self._drives = self._drives, {}
        first = world.first_detection
        world.advance(world.t, world.next_t, drives)
        if first is None and world.first_detection is not None:
            self.tell("the odour is met for the first time", world.first_detector)
        if world.found is not None and not self._reached:
            self._reached = True
            self.tell("the source is reached" if self._by_word else "the source is found", world.found.robot)
        if self._reached and not self._by_word:
            self.end(FOUND)
        elif self._declared(drives):
            self.end(DECLARED)
        elif world.t >= world.scenario.max_time - 1e-9:
            self.end(TIME_OUT)
        else:
            self._begin()

    def lose(self, robot: int, how: str = "lost") -> bool:
        """A robot is gone; whether all live robots have answered now."""
        world = self.world
        self.answered.discard(robot)
        if robot not in world.live or (self.ended is not None and robot in self.reports):
            return False
        world.lose(robot)
        self.declarations.forget(robot)
        self._drives.pop(robot, None)
        if self.ended is None:
            text = f"robot {robot} {how} at {world.t:.2f} s"
            self._note(text, robot)
            if self._nobody_left:
                self.end("all robots are gone")
                return False
        ready = self._started and self.ended is None and not self.awaited
        return ready and len(self._drives) == len(world.live)

    def suspend(self, robot: int, how: str) -> None:
        """A planned fault takes a robot out of the barrier at this tick: it brakes, is not heard, and gets no readings.

        To be called before the readings of the tick are sent. `how`: "crash" or "hang".
        """
        self._inject(Inject(robot, self.world.tick, KILL if how == CRASH else STOP))
        self.stopped.add(robot)
        self.world.lose(robot)
        self.declarations.forget(robot)

    def call(self, robot: int) -> None:
        """Ask a suspended robot to take part again from this tick on; once more when a link to it has come back."""
        if robot not in self.awaited:
            self._inject(Inject(robot, self.world.tick, CONTINUE))
            if not self.waits_for_returns:
                self.admit(robot)
                return
            self.awaited.add(robot)
            self.answered.discard(robot)
        if robot in self._resume:
            self._resume[robot](Resume(robot, self.world.tick))

    def take_linked(self, linked: Linked) -> None:
        """Take a robot's word on its links."""
        if not 0 <= linked.robot < self.world.scenario.robots:
            self.dropped += 1
            return
        self._roster.note(linked)
        if linked.robot in self.awaited and linked.tick == self.world.tick:
            self.answered.add(linked.robot)

    def is_linked(self, robot: int) -> bool:
        """Whether a robot that takes part still has a link to `robot`, as it says itself."""
        return self._roster.is_seen(robot, self.world.live)

    def admit(self, robot: int) -> None:
        """A robot is there: it takes part from this tick on, and the tick begins when nobody else is awaited."""
        self.stopped.discard(robot)
        self.world.admit(robot)
        self._note(f"robot {robot} is back at {self.world.t:.2f} s", robot)
        self._awaited_no_more(robot)

    def give_up(self, robot: int) -> None:
        """A robot that was called does not come: the tick begins without it."""
        self._note(f"robot {robot} did not come back at {self.world.t:.2f} s", robot)
        self._awaited_no_more(robot)

    def _awaited_no_more(self, robot: int) -> None:
        if robot in self.awaited:
            self.awaited.discard(robot)
            if self._nobody_left:
                self.end("all robots are gone")
            elif not self.awaited and self.ended is None:
                self._publish(self.world.readings())

    @property
    def _nobody_left(self) -> bool:
        return not self.world.live and not self.awaited and not self.plan.returns_after(self.world.tick)

    def _begin(self) -> None:
        """The world is at a new tick: let happen what is due, and say what the robots sense."""
        due = self.plan.at(self.world.tick)
        if due is not None:
            self._let_happen(due)
        if not self.awaited and self.ended is None:
            self._publish(self.world.readings())

    def _let_happen(self, due: Due) -> None:
        for robot, text in due.begun:
            self._note(f"injected at {self.world.t:.2f} s: {text}", robot)
        stopping = {robot for robot, _ in due.stops}
        for robot, how in due.stops:
            self.suspend(robot, how)
        for robot in due.back:
            if robot not in stopping:  # one fault goes over into the next
                self.call(robot)
        if self._nobody_left:
            self.end(ALL_STOPPED)

    def _note(self, text: str, robot: int) -> None:
        self.faults.append(text)
        self.tell(text, robot)

    def end(self, why: str) -> None:
        """Finish the run."""
        if self.ended is None:
            self.ended = why
            self._halt(Halt(self.world.tick, why))

    def tell(self, text: str, robot: int = -1) -> None:
        """Note something that a person wants to know."""
        self._tell(Event(self.world.tick, self.world.t, robot, text))

    def _declared(self, drives: Mapping[int, Drive]) -> bool:
        """Whether every live robot told one and the same place."""
        world, declarations = self.world, self.declarations
        for robot, (_, by, x, y) in declarations.take(drives.values()):
            if robot == by:
                self.tell(f"declares the source at ({x:.2f}, {y:.2f})", robot)
        agreed = self._by_word and declarations.agreed(world.live, world.t)
        if agreed:
            self.tell("all robots declare the same place")
        return agreed

    def ask_again(self) -> None:
        """Say once more what was said of this tick: a message may have got lost with a link that came and went.

        Whoever has answered says everything again, for it may be a neighbour that did not hear it.
        """
        if self.awaited:
            for robot in sorted(self.awaited - self.answered):
                self.call(robot)
            for robot in sorted(self.world.live & self._resume.keys()):
                self._resume[robot](Resume(robot, self.world.tick))  # who is at this tick only says who it is linked to
            return
        for reading in self._readings:
            if reading.robot in self.world.live:
                self._send[reading.robot](reading)

    def _publish(self, readings: list[Reading]) -> None:
        self._readings = readings
        for reading in readings:
            self._send[reading.robot](reading)
