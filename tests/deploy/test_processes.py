"""Real processes over real links: the same truth as in memory, and every way in which a run can be disturbed.

Every wait is for a condition with a deadline; the deadlines are generous, because machines are slow and noisy.
"""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable

import psutil
import pytest
import zenoh
from swarm_helpers import folder_left_clean, near_the_plume

from deploy.launch.swarm import SwarmRun
from deploy.memory_run import run_in_memory
from protocol.codec import Codec
from protocol.errors import SwarmFailure
from protocol.messages import Drive, Event, Outcome, Progress
from protocol.scenario import Scenario
from protocol.zenoh_bus import token_of

pytestmark = pytest.mark.processes
DEADLINE = 60.0
ODOURSWARM = [sys.executable, "-m", "deploy.cli"]


def wait_for(condition: Callable[[], bool], what: str, deadline: float = DEADLINE) -> None:
    end = time.monotonic() + deadline
    pause = threading.Event()
    while not condition():
        assert time.monotonic() < end, f"not within {deadline} s: {what}"
        pause.wait(0.01)


class Swarm:
    """A run in a thread, to disturb."""

    def __init__(self, scenario: Scenario, **options):
        self.ticks = 0
        self.live = 0
        self.events: list[str] = []
        self.outcome: Outcome | None = None
        self.error: BaseException | None = None
        self.run = SwarmRun("test", scenario, **options)
        self._thread = threading.Thread(target=self._execute, daemon=True)

    def progress(self, progress: Progress) -> None:
        self.ticks = progress.tick
        self.live = progress.live

    def event(self, event: Event) -> None:
        self.events.append(event.text)

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

    def under_way(self) -> "Swarm":
        wait_for(lambda: self.ticks > 20 or not self._thread.is_alive(), "the run is under way")
        assert self.error is None
        return self

    def pid(self, name: str) -> int:
        return self.run.children.members[name].process.pid

    def finish(self) -> "Swarm":
        self._thread.join(DEADLINE)
        assert not self._thread.is_alive(), "the run did not end"
        return self


@pytest.fixture(autouse=True)
def folder(monkeypatch):
    with folder_left_clean(monkeypatch) as folder:
        yield folder


@pytest.mark.parametrize(
    ("algorithm", "topology"), [("cfpso", "ring"), ("dcs", "line"), ("simple", "all"), ("plume-map", "line")]
)
def test_truth_is_the_same_over_zenoh_and_in_memory(algorithm, topology):
    # So near that robots that sense each other do so.
    near = {"start__spacing": 1.5} if algorithm == "plume-map" else {}
    scenario = near_the_plume(algorithm=algorithm, topology=topology, robots=3, seed=11, max_time=5.0, **near)
    with Swarm(scenario) as swarm:
        swarm.finish()
    assert swarm.error is None
    expected = run_in_memory(scenario)
    assert expected.first_detection is not None
    assert swarm.outcome.digest == expected.digest
    assert swarm.outcome.estimate_error == expected.estimate_error
    assert swarm.outcome.messages["refused"] == swarm.outcome.messages["dropped"] == 0


def stranger(endpoints: list[str]) -> zenoh.Session:
    """Somebody who is linked to everyone and belongs to nobody."""
    config = zenoh.Config()
    for path, value in {
        "mode": "peer",
        "connect/endpoints": endpoints,
        "connect/timeout_ms": 5000,
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
    }.items():
        config.insert_json5(path, json.dumps(value))
    return zenoh.open(config)


def test_strangers_messages_on_every_key_are_counted_and_change_nothing(folder):
    scenario = near_the_plume(topology="ring", seed=6, max_time=60.0, start__y=-45.0)
    with Swarm(scenario) as swarm:
        swarm.under_way()
        endpoints = [f"unixsock-stream/{path}" for path in folder.glob("odour-*/*.sock")]
        assert len(endpoints) == 6
        foreign = Codec(12345).encode(Drive(1, 30, 0.8, 0.8))
        own = Codec(token_of("test")).encode(Drive(1, 30, 0.8, 0.8))
        with stranger(endpoints) as session:
            for leaf in ("reading", "shared", "drive", "report", "belief", "join"):
                for i in range(5):
                    for frame in (b"", b"\xff" * 40, foreign, own[:-1], own + b"x"):
                        session.put(f"odour/test/robot/{i}/{leaf}", frame)
            for key in ("halt", "outcome", "progress", "truth", "alive/robot/1"):
                session.put(f"odour/test/{key}", b"junk")
            swarm.finish()
    assert swarm.error is None
    assert swarm.outcome.messages["refused"] > 0
    assert swarm.outcome.faults == ()
    assert swarm.outcome.digest == run_in_memory(scenario).digest


def test_killed_robot_leaves_the_barrier_and_the_outcome_tells():
    with Swarm(near_the_plume(topology="ring", max_time=100.0, start__y=-45.0)) as swarm:
        swarm.under_way()
        os.kill(swarm.pid("robot/2"), signal.SIGKILL)
        swarm.finish()
    assert swarm.outcome.ended in ("time out", "found")
    assert len(swarm.outcome.faults) == 1
    assert swarm.outcome.faults[0].startswith("robot 2 lost at")
    assert not swarm.outcome.failed
    assert swarm.outcome.ticks > 100


def test_hung_robot_leaves_the_barrier():
    with Swarm(near_the_plume(topology="ring", max_time=60.0, start__y=-45.0)) as swarm:
        swarm.under_way()
        os.kill(swarm.pid("robot/1"), signal.SIGSTOP)
        swarm.finish()
    assert swarm.outcome.faults[0].startswith("robot 1 lost at")


def test_killed_world_ends_every_robot_with_a_status_that_tells():
    with Swarm(near_the_plume(topology="line", max_time=1000.0, start__y=-45.0, search__after="stay")) as swarm:
        swarm.under_way()
        os.kill(swarm.pid("world"), signal.SIGKILL)
        wait_for(
            lambda: all(c.status is not None for n, c in swarm.run.children.members.items() if n != "world"),
            "every robot has ended",
        )
        swarm.finish()
    assert isinstance(swarm.error, SwarmFailure)
    assert "world ended with signal 9" in str(swarm.error)


def test_robot_that_dies_before_the_start_ends_the_run_with_a_sentence():
    with Swarm(near_the_plume(topology="ring")) as swarm:
        wait_for(lambda: swarm.run.children is not None and "robot/4" in swarm.run.children.members, "robots started")
        os.kill(swarm.pid("robot/4"), signal.SIGKILL)
        swarm.finish()
    assert isinstance(swarm.error, SwarmFailure) or swarm.outcome.faults


def odourswarm(*arguments: str, **options) -> subprocess.Popen:
    return subprocess.Popen(
        [*ODOURSWARM, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options
    )


def test_command_prints_one_object_and_nothing_else_there():
    scenario = ["--robots", "3", "--topology", "line", "--seed", "4", "--max-time", "2", "--json"]
    process = odourswarm("run", *scenario)
    stdout, stderr = process.communicate(timeout=DEADLINE)
    assert process.returncode == 0, stderr
    assert stderr == ""
    outcome = json.loads(stdout)
    assert {
        "found", "time", "finder", "ticks", "wall_s", "ticks_per_s", "digest", "distance_travelled", "estimate_error",
        "min_pair_distance", "run", "seed", "scenario_digest", "faults", "messages",
    } <= outcome.keys()  # fmt: skip
    assert outcome["ticks"] == 40
    in_memory = odourswarm("run", *scenario, "--bus", "memory")
    stdout, _ = in_memory.communicate(timeout=DEADLINE)
    assert json.loads(stdout)["digest"] == outcome["digest"]


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_run_ends_all_processes_and_leaves_a_readable_recording(how, folder):
    recording = folder / "run.rrd"
    process = odourswarm("run", "--max-time", "5000", "--set", "search.after=stay", "--record", str(recording))
    try:
        wait_for(lambda: recording.exists() and recording.stat().st_size > 50_000, "the recording has grown")
        process.send_signal(how)
        _, stderr = process.communicate(timeout=DEADLINE)
    finally:
        process.kill()
    assert process.returncode == 130
    assert "interrupted; all processes have ended" in stderr
    verify = [sys.executable, "-m", "rerun", "rrd", "verify", str(recording)]
    verified = subprocess.run(verify, capture_output=True, check=False)
    assert verified.returncode == 0, verified.stderr


def test_launcher_that_is_killed_takes_everyone_along(folder):
    process = odourswarm("run", "--max-time", "5000", "--set", "search.after=stay")
    swarm: list[psutil.Process] = []

    def all_started() -> bool:
        swarm[:] = psutil.Process(process.pid).children(recursive=True)
        return len(swarm) == 6

    wait_for(all_started, "world and robots have started")
    process.kill()
    process.communicate(timeout=DEADLINE)
    wait_for(lambda: not any(p.is_running() and p.status() != psutil.STATUS_ZOMBIE for p in swarm), "all have ended")
    wait_for(lambda: not list(folder.glob("odour-*")), "the run's folder is gone")


def free_ports(count: int) -> list[int]:
    import socket

    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


def test_world_and_robots_by_hand_over_tcp():
    endpoints = [f"tcp/127.0.0.1:{port}" for port in free_ports(4)]
    settings = {
        "robots": 3,
        "topology": '"line"',
        "max_time": 2,
        "seed": 9,
        "network.endpoints": json.dumps(endpoints),
    }
    flags = [part for name, value in settings.items() for part in ("--set", f"{name}={value}")]
    processes = [odourswarm("world", "--run", "by-hand", *flags, "--json")]
    try:
        processes += [
            odourswarm("robot", "--run", "by-hand", "--id", str(i), "--world", endpoints[0]) for i in (2, 0, 1)
        ]
        said = [process.communicate(timeout=DEADLINE) for process in processes]
    finally:
        for process in processes:
            process.kill()
    assert [process.returncode for process in processes] == [0, 0, 0, 0], said
    outcome = json.loads(said[0][0])
    by_default = {"start__x": 95.0, "start__y": -48.0, "plume__warm_up": 300.0}
    expected = run_in_memory(near_the_plume(**by_default, robots=3, topology="line", max_time=2.0, seed=9))
    assert outcome["digest"] == expected.digest
