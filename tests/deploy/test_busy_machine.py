"""A machine that stands still for a while, or that one robot's process is stopped on: who is lost, and who is not."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

import psutil
import pytest

from deploy.launch.children import Child, Children
from deploy.launch.standstill import EVERY, HELD_UP, Standstill
from deploy.memory_run import run_in_memory
from protocol.messages import Stopped
from protocol.scenario.load import load_scenario

unix_only = pytest.mark.skipif(sys.platform == "win32", reason="needs process groups and SIGSTOP")
DEADLINE = 90.0  # s
STANDS_STILL = 0.8  # s: twice what links were once given
VALUES = {"robots": 3, "topology": "line", "seed": 3, "max_time": 30.0, "start.y": -6.0, "start.x": 60.0,
          "plume.warm_up": 60.0, "search.after": "stay"}  # fmt: skip


def wait_for(condition: Callable[[], bool], what: str) -> None:
    end, pause = time.monotonic() + DEADLINE, threading.Event()
    while not condition():
        assert time.monotonic() < end, f"not within {DEADLINE} s: {what}"
        pause.wait(0.005)


@unix_only
@pytest.mark.processes
def test_a_machine_that_stands_still_loses_no_robot_and_changes_no_digest():
    """All processes of a run, the launcher too, are held up together, as when a machine has far more to do than it can."""
    chosen = [flag for name, value in VALUES.items() for flag in ("--set", f"{name}={json.dumps(value)}")]
    with tempfile.TemporaryDirectory(prefix="t-") as folder:
        history = Path(folder) / "h"
        run = subprocess.Popen(
            [sys.executable, "-m", "deploy.cli", "run", "--json", "--history", str(history), *chosen],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
        )  # fmt: skip
        try:
            for size in (2_000, 20_000):  # of the histories so far, bytes
                wait_for(
                    lambda size=size: sum(f.stat().st_size for f in history.glob("*")) > size or run.poll() is not None,
                    "the run goes on",
                )
                assert run.poll() is None, "the run was over before it could be held up"
                os.killpg(run.pid, signal.SIGSTOP)
                threading.Event().wait(STANDS_STILL)
                os.killpg(run.pid, signal.SIGCONT)
            stdout, stderr = run.communicate(timeout=DEADLINE)
        finally:
            if run.poll() is None:
                os.killpg(run.pid, signal.SIGKILL)
    assert run.returncode == 0, stderr
    outcome = json.loads(stdout)
    expected = run_in_memory(load_scenario(None, overrides=[(name, value, "test") for name, value in VALUES.items()]))
    assert outcome["faults"] == []
    assert outcome["digest"] == expected.digest


@unix_only
def test_a_process_that_is_stopped_is_told_of_at_the_second_look_and_again_when_it_goes_on(tmp_path):
    told: list[Stopped] = []
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as process:
        children = Children(tmp_path)
        standstill = Standstill(children, told.append, planned=())
        children.members["robot/1"] = Child("robot/1", process, tmp_path / "log")
        seen = psutil.Process(process.pid)
        standstill.look(0.0)
        process.send_signal(signal.SIGSTOP)
        wait_for(lambda: seen.status() == psutil.STATUS_STOPPED, "it is stopped")
        standstill.look(1.0 * EVERY)
        standstill.look(1.5 * EVERY)  # too soon to be a look
        assert told == []
        standstill.look(2.0 * EVERY)
        standstill.look(3.0 * EVERY)
        assert told == [Stopped(1, True)]
        process.send_signal(signal.SIGCONT)
        wait_for(lambda: seen.status() != psutil.STATUS_STOPPED, "it goes on")
        standstill.look(4.0 * EVERY)
        standstill.look(5.0 * EVERY)
        assert told == [Stopped(1, True), Stopped(1, False)]
        process.send_signal(signal.SIGSTOP)
        wait_for(lambda: seen.status() == psutil.STATUS_STOPPED, "it is stopped again")
        standstill.look(6.0 * EVERY)
        held_up = 6.0 * EVERY + 2.0 * HELD_UP
        standstill.look(held_up)  # the launcher has just come back itself: this is a first look
        assert len(told) == 2
        standstill.look(held_up + 1.0 * EVERY)
        assert told[2:] == [Stopped(1, True)]
        process.kill()


@unix_only
def test_a_planned_standstill_is_no_news(tmp_path):
    told: list[Stopped] = []
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as process:
        children = Children(tmp_path, {"robot/0": Child("robot/0", process, tmp_path / "log")})
        process.send_signal(signal.SIGSTOP)
        wait_for(lambda: psutil.Process(process.pid).status() == psutil.STATUS_STOPPED, "it is stopped")
        standstill = Standstill(children, told.append, planned={"robot/0"})
        for n in range(4):
            standstill.look(n * EVERY)
        assert told == []
        process.kill()
