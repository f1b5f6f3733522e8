"""A barrier that can be built again: all that happens to it is told to a journal, and a journal can be lived through again.

Rules: no clock, no socket. What is told is what comes from outside: drives, robots that are lost, return or do not; what
the scenario plans follows by itself. It is told before it happens, so that nobody outside ever knows more than the
journal. A session that replays says nothing to anybody.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import msgspec
from msgspec import Struct

from protocol.messages import DeclaredRecord, Drive, Event, Halt, Inject, Reading, Resume
from world_server.faults.plan import CRASH
from world_server.session import CONTINUE, KILL, STOP, WorldSession
from world_server.world import World


class Stepped(Struct, frozen=True, array_like=True, tag="s"):
    """All who were waited for had answered."""

    drives: tuple[tuple[int, float, float], ...]  # robot, torques, N m
    declared: tuple[tuple[int, DeclaredRecord], ...] = ()  # what robots said of the source, as far as it was new


class Left(Struct, frozen=True, array_like=True, tag="l"):
    """A robot was lost."""

    robot: int
    how: str


class Came(Struct, frozen=True, array_like=True, tag="c"):
    """A robot whose process was started again asked to take part from `tick` on."""

    robot: int
    tick: int


class Admitted(Struct, frozen=True, array_like=True, tag="a"):
    """A robot that was waited for was there."""

    robot: int


class GivenUp(Struct, frozen=True, array_like=True, tag="g"):
    """A robot that was waited for did not come."""

    robot: int


Input = Stepped | Left | Came | Admitted | GivenUp


class SessionState(Struct, frozen=True, array_like=True):
    """A session between two ticks, when nobody is awaited."""

    faults: tuple[str, ...]
    dropped: int
    stopped: tuple[int, ...]
    returning: tuple[tuple[int, int], ...]  # (tick, robot) of returns that no fault had planned
    started: bool
    declared: tuple[tuple[int, DeclaredRecord], ...] = ()  # what each robot said last of the source


class RecoverableSession(WorldSession):
    """A `WorldSession` with a journal, for a swarm whose processes may be started again.

    `patient`: without any robot the run does not end but stands still, until one comes or the shell ends it.
    """

    def __init__(
        self,
        world: World,
        send: Mapping[int, Callable[[Reading], None]],
        halt: Callable[[Halt], None],
        tell: Callable[[Event], None],
        resume: Mapping[int, Callable[[Resume], None]],
        inject: Callable[[Inject], None],
        journal: Callable[[Input], None] = lambda _: None,
        *,
        patient: bool = False,
    ) -> None:
        super().__init__(world, send, halt, tell, resume, inject)
        self.patient = patient
        self._journal = journal
        self._returning: dict[int, int] = {}  # robot -> tick

    @property
    def started(self) -> bool:
        """Whether the first readings have been sent."""
        return self._started

    @property
    def quiet(self) -> bool:
        """Whether this is a moment to take a snapshot."""
        return not self._drives and not self.awaited and self.ended is None

    @property
    def deserted(self) -> bool:
        """Whether the clock stands still because all robots are gone and one of them may be started again."""
        unplanned = not self.world.live.union(self.stopped).issuperset(range(self.world.scenario.robots))
        return self.patient and unplanned and super().idle and not self.plan.returns_after(self.world.tick)

    @property
    def idle(self) -> bool:
        return super().idle and not self.deserted

    def snapshot(self) -> bytes:
        """The state when `quiet`; the world's own is not in it."""
        tick = self.world.tick
        returning = tuple((at, robot) for robot, at in self._returning.items() if at > tick)
        stopped, declared = tuple(sorted(self.stopped)), tuple(self.declarations.of.items())
        return msgspec.msgpack.encode(
            SessionState(tuple(self.faults), self.dropped, stopped, returning, self._started, declared)
        )

    def restore(self, snapshot: bytes, inputs: Iterable[Input]) -> None:
        """Be as the session of `snapshot` was when it had taken `inputs`, without a word to anybody.

        Its world is the one that was saved with it. `go_on` lets the run go on.
        """
        state = msgspec.msgpack.decode(snapshot, type=SessionState)
        self.faults, self.dropped, self.stopped = list(state.faults), state.dropped, set(state.stopped)
        for tick, robot in state.returning:
            self._return_at(tick, robot)
        self._started = state.started
        self._reached = self.world.found is not None
        self.declarations.of = dict(state.declared)
        outside = self._journal, self._send, self._halt, self._tell, self._resume, self._inject
        self._journal = lambda _: None
        self._send = {i: lambda _: None for i in self._send}
        self._resume = {}
        self._halt = lambda _: None
        self._tell = lambda _: None
        self._inject = lambda _: None
        for each in inputs:
            self._take_again(each)
        self._journal, self._send, self._halt, self._tell, self._resume, self._inject = outside

    def go_on(self) -> None:
        """After `restore`: say once more what may not have been heard of the present tick, and go on from there."""
        world = self.world
        if not self._started:
            self.start()
            return
        if self.ended is not None:
            self._halt(Halt(world.tick, self.ended))
            return
        self.tell(f"the world is back at {world.t:.2f} s")
        due = self.plan.at(world.tick)
        for robot, how in due.stops if due is not None else ():
            if robot in self.stopped:
                self._inject(Inject(robot, world.tick, KILL if how == CRASH else STOP))
        for robot in sorted(self.awaited):
            self._inject(Inject(robot, world.tick, CONTINUE))
            self.call(robot)
        if not self.awaited:
            self._publish(world.readings())

    def come(self, robot: int) -> None:
        """A robot whose process is there does not take part: it is called at the next tick, or now when nobody drives.

        Nothing happens when it does take part, or when a planned fault keeps it out.
        """
        world = self.world
        if self.ended is not None or not self._started or not 0 <= robot < world.scenario.robots:
            return
        if robot in world.live or robot in self.stopped or robot in self.awaited or self.plan.returns(robot, world.tick):
            return
        came = Came(robot, world.tick if self.deserted else world.tick + 1)
        self._journal(came)
        self._expect(came)

    def step(self) -> None:
        drives, known = self._drives, self.declarations.of
        new = tuple([(i, d.declared) for i, d in drives.items() if d.declared is not None and d.declared != known.get(i)])
        self._journal(Stepped(tuple([(i, d.tau_left, d.tau_right) for i, d in drives.items()]), new))
        super().step()

    def lose(self, robot: int, how: str = "lost") -> bool:
        if robot in self.world.live and self.ended is None:
            self._journal(Left(robot, how))
        return super().lose(robot, how) and not self.deserted

    def admit(self, robot: int) -> None:
        self._journal(Admitted(robot))
        super().admit(robot)

    def give_up(self, robot: int) -> None:
        self._journal(GivenUp(robot))
        super().give_up(robot)

    @property
    def _nobody_left(self) -> bool:
        return super()._nobody_left and not self.deserted

    def _expect(self, came: Came) -> None:
        if came.tick == self.world.tick:
            self.call(came.robot)
        else:
            self._return_at(came.tick, came.robot)

    def _return_at(self, tick: int, robot: int) -> None:
        self._returning[robot] = tick
        self.plan.add_return(tick, robot)

    def _take_again(self, each: Input) -> None:
        tick = self.world.tick
        match each:
            case Stepped(drives, declared):
                said = dict(declared)
                self._drives = {i: Drive(i, tick, left, right, said.get(i)) for i, left, right in drives}
                if not self._started:
                    self.start()
                self.step()
            case Left(robot, how):
                self.lose(robot, how)
            case Came():
                self._expect(each)
            case Admitted(robot):
                self.admit(robot)
            case GivenUp(robot):
                self.give_up(robot)
