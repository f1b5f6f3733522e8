"""One random fault schedule tried: does the run end with an outcome, twice the same, with all its promises kept?

Rules: whatever a try does, it ends with a `Trial` and leaves no process behind; what went wrong is a list of sentences, and
an empty one is a success. To be called from a process's main thread: an alarm ends what hangs.
"""

from __future__ import annotations

import os
import signal
import tempfile
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType
from typing import Literal, NoReturn

import msgspec
import psutil

from deploy.checkers.check import History, read_folder, read_memory, unplanned
from deploy.faults.random_fault import below, one
from deploy.faults.random_schedule import random_scenario
from deploy.launch.swarm import SwarmRun
from deploy.memory_run import run_in_memory
from protocol import keys
from protocol.errors import SwarmFailure
from protocol.history.file import HistoryMemory
from protocol.messages import Event, Outcome, Progress
from protocol.randomness import rng_for
from protocol.scenario import Scenario
from world_server.session import ALL_STOPPED, DECLARED, FOUND, TIME_OUT

Where = Literal["memory", "processes"]
ENDS = (FOUND, DECLARED, TIME_OUT, ALL_STOPPED)
BY_THE_WALL = ("wall_s", "ticks_per_s", "messages", "run")  # what two equal runs may differ in
LEASE = 5000  # ms: on a loaded machine links are silent for longer than a swarm of its own would allow


class Trial(msgspec.Struct, frozen=True):
    """What came of one schedule."""

    number: int
    where: Where
    max_time: float  # s
    about: str  # the swarm, in a few words
    faults: tuple[str, ...]  # kinds
    ended: str
    wrong: tuple[str, ...]  # empty: all is well
    killed: str = ""  # member that was killed besides, over processes: "world", or a robot, which is no part of the plan
    wall_s: float = 0.0


class _TooLongError(Exception):
    """The alarm."""


def try_schedule(number: int, where: Where, max_time: float, deadline: float) -> Trial:
    """Try schedule `number`.

    Args:
        max_time: simulated s of the run.
        deadline: wall-clock s after which it counts as hung, and is ended.
    """
    began = time.perf_counter()
    about, found = "", _Found()
    kinds: tuple[str, ...] = ()
    try:
        scenario = random_scenario(number, max_time)
        about, kinds = describe(scenario), tuple(str(each.__struct_config__.tag) for each in scenario.faults)
        with _alarm(deadline):
            _in_memory(scenario, found) if where == "memory" else _over_processes(number, scenario, found)
    except _TooLongError as hung:
        found.wrong.append(f"hangs: no end within {deadline:g} s, in {_place(hung)}")
    except SwarmFailure as failure:
        found.wrong.append(f"failed: {failure}")
    except Exception as error:  # whatever it is, the other schedules go on
        found.wrong.append(f"{type(error).__name__} in {_place(error)}: {' '.join(str(error).split())}")
    wall_s = round(time.perf_counter() - began, 2)
    return Trial(number, where, max_time, about, kinds, found.ended, tuple(found.wrong), found.killed, wall_s)


def describe(scenario: Scenario) -> str:
    """The swarm of a schedule in a few words."""
    resilient = f", {scenario.fusion.kind} fusion" if scenario.fusion.kind != "plain" else ""
    stop = ", stop = declared" if scenario.declaration.stop == "declared" else ""
    return f"{scenario.algorithm}, {scenario.robots} robots, {scenario.topology}{resilient}{stop}"


@dataclass(slots=True)
class _Found:
    """What is known of a trial so far."""

    ended: str = ""
    wrong: list[str] = field(default_factory=list)
    killed: str = ""

    def look(self, outcome: Outcome, history: History) -> None:
        """What holds of every run."""
        self.ended = outcome.ended
        if outcome.ended not in ENDS or outcome.failed:
            self.wrong.append(f"ended unplanned: {outcome.ended}")
        self.wrong += [f"{finding.name}: {finding.counterexample}" for finding in unplanned(history)]

    def compare(self, outcome: Outcome, expected: Outcome, against: str) -> None:
        """What holds of two runs of one scenario."""
        for name in Outcome.__struct_fields__:
            this, that = getattr(outcome, name), getattr(expected, name)
            if name not in BY_THE_WALL and this != that:
                self.wrong.append(f"{name} is not as {against}: {this}, and {that}")
        refused, expected_refused = outcome.messages["refused"], expected.messages["refused"]  # impossible states, too
        if refused != expected_refused:
            self.wrong.append(f"{refused} messages were refused, and {expected_refused} {against}")


def _in_memory(scenario: Scenario, found: _Found) -> None:
    histories = HistoryMemory()
    first = run_in_memory(scenario, history=histories)
    second = run_in_memory(scenario, wire=True)
    found.compare(first, second, "the second time")
    found.look(first, read_memory(histories))


def _over_processes(number: int, scenario: Scenario, found: _Found) -> None:
    expected = run_in_memory(scenario)
    tcp = rng_for(number, "schedule", "transport").uniform() < 0.2
    network = msgspec.structs.replace(scenario.network, lease_ms=LEASE, transport="tcp" if tcp else "auto")
    scenario = msgspec.structs.replace(scenario, network=network)
    disturber = _Disturber(found)
    draws = rng_for(number, "schedule", "killed")
    which = draws.uniform()
    kill_at = int(draws.uniform() * 0.7 * scenario.max_time / scenario.timing.tick)
    supervision = scenario.supervision
    if which < 0.5:
        supervision = msgspec.structs.replace(supervision, checkpoint_every=one(draws, (0.5, 1.0, 2.0)))
        disturber.kill = (kill_at, keys.WORLD)
    if 0.35 < which < 0.7:
        supervision = msgspec.structs.replace(supervision, restart="always")
        disturber.kill = (kill_at, keys.robot_name(below(draws, scenario.robots)))
    scenario = msgspec.structs.replace(scenario, supervision=supervision)
    name = f"try-{os.getpid()}-{number}"
    with tempfile.TemporaryDirectory(prefix="odour-try-") as folder:
        try:
            run = disturber.run = SwarmRun(name, scenario, history=Path(folder))
            outcome = run.execute(disturber)
            found.look(outcome, read_folder(Path(folder)))
            if found.killed in ("", keys.WORLD):  # a robot that nobody planned to lose makes another run of it
                found.compare(outcome, expected, "in memory")
        finally:
            found.wrong += [f"left behind: {words}" for words in _left_behind(name)]


@dataclass(slots=True)
class _Disturber:
    """Watches a run, and kills one of its processes once."""

    found: _Found
    run: SwarmRun | None = None
    kill: tuple[int, str] | None = None  # from which tick on, whom

    def progress(self, progress: Progress) -> None:
        if self.kill is None or progress.tick < self.kill[0] or self.run is None or self.run.children is None:
            return
        (_, name), self.kill = self.kill, None
        process = self.run.children.members[name].process
        if process.poll() is None:
            process.kill()
            self.found.killed = name

    def event(self, event: Event) -> None:
        """Nobody listens."""


def _left_behind(run: str) -> Iterator[str]:
    """End the processes that belong to a run that is over, whoever their parent is by now; who they were."""
    for process in psutil.process_iter():
        try:
            words = process.cmdline()
            if run in words and process.is_running() and process.status() != psutil.STATUS_ZOMBIE:
                yield " ".join(words[1:4])
                process.kill()
        except psutil.Error:
            continue


@contextmanager
def _alarm(seconds: float) -> Iterator[None]:
    """Raises: _TooLongError in what is done under it, after so many seconds."""

    def ring(signum: int, frame: FrameType | None) -> NoReturn:
        raise _TooLongError

    before: Callable[[int, FrameType | None], object] | int | None = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def _place(error: Exception) -> str:
    """Where in our code it was raised."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [f for f in frames if any(part in f.filename for part in ("deploy", "robot_agent", "world_server", "protocol"))]
    frame = (ours or frames)[-1] if not isinstance(error, _TooLongError) else (ours[:-1] or frames)[-1]
    return f"{Path(frame.filename).name}, line {frame.lineno}"
