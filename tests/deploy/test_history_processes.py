"""Histories of real processes: a robot that is killed leaves what it finished, and the run keeps its promises."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from deploy.checkers.check import check_run, read_folder
from deploy.memory_run import run_in_memory
from protocol.history.file import HistoryMemory

pytestmark = pytest.mark.processes
DEADLINE = 90.0
NEAR = ["--set", "start.y=-6", "--set", "start.x=60", "--set", "plume.warm_up=60"]


def start(folder: Path, *flags: str) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "deploy.cli", "run", "--history", str(folder), "--json", *NEAR, *flags]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def wait_until(condition, what: str) -> None:
    end = time.monotonic() + DEADLINE
    while not condition():
        assert time.monotonic() < end, f"not within {DEADLINE} s: {what}"
        time.sleep(0.01)


def test_processes_write_what_the_run_in_memory_writes(tmp_path):
    run = start(tmp_path, "--max-time", "4", "-n", "3")
    assert run.wait(DEADLINE) == 0
    run.communicate()
    history = read_folder(tmp_path)
    assert [finding.counterexample for finding in check_run(history) if not finding.passed] == []
    memory = HistoryMemory()
    run_in_memory(history.scenario, history=memory)
    for member, data in memory.members.items():
        file = (tmp_path / (member.replace("/", "-") + ".history")).read_bytes()
        # All but the run's name, which stands in the first record.
        assert file[_first(file) :] == bytes(data[_first(bytes(data)) :]), member


def _first(data: bytes) -> int:
    return 8 + int.from_bytes(data[:4], "little")


def test_a_killed_robot_leaves_a_history_that_keeps_every_promise(tmp_path):
    run = start(tmp_path, "--max-time", "100")
    try:
        file = tmp_path / "robot-2.history"
        wait_until(lambda: file.exists() and file.stat().st_size > 20_000, "robot 2 is under way")
        victim = next(
            p.pid for p in psutil.Process(run.pid).children(recursive=True) if "place-2.json" in " ".join(p.cmdline())
        )
        os.kill(victim, signal.SIGKILL)
        out, err = run.communicate(timeout=DEADLINE)
    finally:
        if run.poll() is None:
            run.terminate()
            run.communicate(timeout=DEADLINE)
    assert run.returncode in (0, 3), err
    history = read_folder(tmp_path)
    assert 2 in history.moved[-1].dead, out
    assert [finding.counterexample for finding in check_run(history) if not finding.passed] == []
    assert next(f for f in check_run(history) if f.name == "stopped").facts > 0
