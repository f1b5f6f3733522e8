"""Real time over real processes: the wall clock goes on, whoever hangs or dies."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable

import numpy as np
import psutil
import pytest
from swarm_helpers import folder_left_clean, near_the_plume

from deploy.launch.swarm import SwarmRun
from protocol.errors import SwarmFailure
from protocol.messages import Event, Outcome, Progress, Truth

pytestmark = pytest.mark.processes
DEADLINE = 60.0


def wait_for(condition: Callable[[], bool], what: str) -> None:
    end = time.monotonic() + DEADLINE
    pause = threading.Event()
    while not condition():
        assert time.monotonic() < end, f"not within {DEADLINE} s: {what}"
        pause.wait(0.005)


class Swarm:
    """A real-time run in a thread, to disturb."""

    def __init__(self, **values: object) -> None:
        chosen = {"clock": "realtime", "robots": 3, "topology": "line", "plume__warm_up": 60.0, **values}
        self.t = 0.0
        self.events: list[Event] = []
        self.outcome: Outcome | None = None
        self.error: BaseException | None = None
        self.speeds: list[float] = []  # of all robots, m/s
        self.run = SwarmRun("test", near_the_plume(**chosen), truth=self.take)
        self._thread = threading.Thread(target=self._execute, daemon=True)

    def progress(self, progress: Progress) -> None:
        self.t = progress.t

    def take(self, truth: Truth) -> None:
        self.speeds = np.frombuffer(truth.robots, "<f8").reshape(-1, 9)[:, 3].tolist()

    def event(self, event: Event) -> None:
        self.events.append(event)

    def _execute(self) -> None:
        try:
            self.outcome = self.run.execute(self)
        except BaseException as error:
            self.error = error

    def __enter__(self) -> "Swarm":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.finish()

    def at(self, t: float) -> "Swarm":
        wait_for(lambda: self.t >= t or not self._thread.is_alive(), f"simulated time {t} s")
        assert self.error is None
        return self

    def told(self, text: str) -> list[Event]:
        return [event for event in self.events if text in event.text]

    def fates(self, robot: int) -> list[str]:
        """When a robot was lost and came back; on a machine that is very busy also for nothing."""
        return [f.split(" at ")[0] for f in self.outcome.faults if f.startswith(f"robot {robot} ")]

    def process(self, name: str) -> psutil.Process:
        return psutil.Process(self.run.children.members[name].process.pid)

    def finish(self) -> "Swarm":
        self._thread.join(DEADLINE)
        assert not self._thread.is_alive(), "the run did not end"
        return self


@pytest.fixture(autouse=True)
def folder(monkeypatch):
    with folder_left_clean(monkeypatch) as folder:
        yield folder


def test_three_robots_find_the_source_at_five_times_the_pace_of_the_clock():
    with Swarm(realtime__speed=5.0, source__x=58.0, source__y=0.0, max_time=200.0) as swarm:
        swarm.finish()
    outcome = swarm.outcome
    assert swarm.error is None
    assert outcome.ended == "found"
    assert outcome.clock == "realtime"
    assert outcome.messages["refused"] == 0
    # By the clock, but for what the world says to have given up on a busy machine, and the last fraction of a tick.
    assert outcome.wall_s >= (outcome.time - 0.1) / 5.0 + outcome.slip - 0.1
    assert len(outcome.missed) == 3


def test_a_stopped_robot_brakes_alone_and_drives_again_when_it_goes_on():
    with Swarm(max_time=9.0, plume__release_rate=0.0) as swarm:
        frozen = swarm.at(2.0).process("robot/1")
        frozen.suspend()
        wait_for(lambda: bool(swarm.told("robot 1 lost")), "the world notices the hang")
        lost_at = swarm.told("robot 1 lost")[0].t
        swarm.at(lost_at + 1.5)
        standing = swarm.speeds
        frozen.resume()
        wait_for(lambda: bool(swarm.told("robot 1 is back")), "the robot is back")
        swarm.at(swarm.told("robot 1 is back")[0].t + 1.5)
        driving = swarm.speeds
    outcome = swarm.outcome
    assert outcome.ended == "time out"
    assert not outcome.failed
    assert swarm.fates(1)[-2:] == ["robot 1 lost", "robot 1 is back"]
    assert outcome.missed[1] > 0
    assert standing[1] == pytest.approx(0.0, abs=1e-9)
    assert min(standing[0], standing[2], driving[1]) > 0.05
    assert outcome.ticks == 180


def test_planned_faults_happen_to_the_processes():
    faults = [
        {"kind": "crash", "at": 1.0, "robot": 0},
        {"kind": "hang", "at": 1.5, "until": 3.5, "robot": 2},
        {"kind": "loss", "probability": 0.5},
    ]
    with Swarm(max_time=6.0, plume__release_rate=0.0, faults=faults) as swarm:
        crashed = swarm.at(0.2).process("robot/0")
        swarm.finish()
    assert not crashed.is_running()
    assert swarm.outcome.ended == "time out"
    assert swarm.fates(0)[-1] == "robot 0 lost"
    assert swarm.fates(2)[-2:] == ["robot 2 lost", "robot 2 is back"]


def comes_back_and_drives(swarm: Swarm, robot: int, kill: Callable[[], None] = lambda: None) -> None:
    """Robot `robot` is lost, a new process takes its place, and its body moves again."""
    first = swarm.at(0.5).process(f"robot/{robot}")
    kill()
    wait_for(lambda: bool(swarm.told(f"robot {robot} is back")), "the robot is back")
    assert not first.is_running()
    assert swarm.process(f"robot/{robot}").pid != first.pid
    wait_for(lambda: abs(swarm.speeds[robot]) > 0.05, "the new process drives")


def test_a_killed_robot_is_started_again_and_drives():
    with Swarm(realtime__speed=5.0, max_time=1000.0, plume__release_rate=0.0, supervision__restart="always") as swarm:
        comes_back_and_drives(swarm, 1, lambda: os.kill(swarm.process("robot/1").pid, signal.SIGKILL))
        swarm.process("world").terminate()
    assert swarm.error is None
    assert swarm.outcome.ended == "interrupted"
    assert swarm.fates(1)[:2] == ["robot 1 lost", "robot 1 is back"]
    assert swarm.told("robot 1 ended with signal 9 and is started again")


def test_a_robot_that_crashes_as_planned_is_started_again_and_drives():
    crash = {"kind": "crash", "at": 3.0, "robot": 2, "restart": 15.0}
    with Swarm(realtime__speed=5.0, max_time=1000.0, plume__release_rate=0.0, faults=[crash]) as swarm:
        comes_back_and_drives(swarm, 2)
        swarm.process("world").terminate()
    assert swarm.error is None
    assert swarm.fates(2)[-2:] == ["robot 2 lost", "robot 2 is back"]
    # Not before its time, by the clock of the launcher; the world's may be behind it by what it has given up.
    lost, back = (swarm.told(f"robot 2 {what}")[-1].t for what in ("lost", "is back"))
    assert back - lost > 15.0 - 5.0 * swarm.outcome.slip - 1.0


def test_killed_world_ends_every_robot():
    with Swarm(max_time=1000.0, plume__release_rate=0.0, realtime__alone=0.5) as swarm:
        robots = [swarm.at(0.5).process(f"robot/{i}") for i in range(3)]
        os.kill(swarm.process("world").pid, signal.SIGKILL)
        swarm.finish()
        wait_for(lambda: not any(p.is_running() for p in robots), "every robot has ended")
    assert isinstance(swarm.error, SwarmFailure)
    assert "world ended with signal 9" in str(swarm.error)


def test_a_run_that_lost_all_its_robots_ends():
    with Swarm(max_time=1000.0, plume__release_rate=0.0, realtime__alone=0.5) as swarm:
        for i in range(3):
            swarm.at(0.5).process(f"robot/{i}").kill()
        swarm.finish()
    assert swarm.outcome.ended == "all robots are gone"
    assert swarm.outcome.failed


def test_the_command_ends_a_real_time_run_at_once_when_interrupted():
    command = [sys.executable, "-m", "deploy.cli", "run", "--clock", "realtime", "--speed", "2", "--robots", "2"]
    process = subprocess.Popen([*command, "--topology", "line"], stderr=subprocess.PIPE, text=True)
    try:
        wait_for(lambda: len(psutil.Process(process.pid).children()) == 3, "world and robots have started")
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate(timeout=DEADLINE)
    finally:
        process.kill()
    assert process.returncode == 130
    assert "interrupted; all processes have ended" in stderr


def test_bad_clocks_are_refused_in_a_sentence():
    command = [sys.executable, "-m", "deploy.cli", "run", "--json"]
    for flags, words in (
        (["--clock", "realtime", "--bus", "memory"], "--bus zenoh"),
        (["--speed", "2"], "add --clock realtime"),
        (["--clock", "sundial"], '"lockstep" or "realtime"'),
        (["--clock", "realtime", "--speed", "0"], "from 0.01 to 1000"),
    ):
        done = subprocess.run([*command, *flags], capture_output=True, text=True, check=False, timeout=DEADLINE)
        assert done.returncode == 2, flags
        assert words in done.stderr
        assert done.stdout == ""


def test_the_outcome_on_standard_output_says_that_it_does_not_repeat():
    command = [sys.executable, "-m", "deploy.cli", "run", "--json", "--clock", "realtime", "--speed", "10"]
    done = subprocess.run(
        [*command, "--robots", "2", "--topology", "line", "--max-time", "2", "--set", "plume.warm_up=10"],
        capture_output=True, text=True, check=False, timeout=DEADLINE,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    outcome = json.loads(done.stdout)
    assert outcome["clock"] == "realtime"
    assert outcome["ticks"] == 40
    assert len(outcome["missed"]) == 2
