"""How long a killed robot, and a killed world, are missed in lock-step over real processes.

    python tests/benchmarks/bench_recovery.py [--robots 5] [--count 10] [--only robots world]

`robots`: one after the other is killed (SIGKILL) and started again at once. Four times of each, up to the first drive of
the new process that the world used: from the kill, from the start of the new process, and from when it was ready to link
(its socket is there; what lies before is the interpreter's start-up); and how long the world took to notice.
`world`: the world is killed and comes back from its checkpoint and journal; from the kill until it is back and goes on.
How soon neighbours see a crash or a hang is measured by bench_realtime.py.
"""

from __future__ import annotations

import argparse
import os
import signal
import statistics
import threading
import time
from pathlib import Path

import psutil

from deploy.launch.swarm import SwarmRun
from protocol.messages import Event, Progress
from protocol.scenario.load import load_scenario

DEADLINE = 60.0  # s


class Run:
    """A run in a thread, and when what was said of it."""

    def __init__(self, robots: int, **values: object) -> None:
        chosen = {
            "robots": robots, "topology": "ring", "max_time": 1e6, "search.after": "stay", "plume.release_rate": 0.0,
            "supervision.max_restarts": 1000, "supervision.backoff": 0.001, "supervision.max_backoff": 0.001,
        } | values  # fmt: skip
        scenario = load_scenario(None, overrides=[(name, value, "bench") for name, value in chosen.items()])
        self.swarm = SwarmRun("bench", scenario)
        self.live = self.tick = 0
        self.said: list[tuple[float, str]] = []
        self._thread = threading.Thread(target=self.swarm.execute, args=(self,), daemon=True)

    def progress(self, progress: Progress) -> None:
        self.live, self.tick = progress.live, progress.tick

    def event(self, event: Event) -> None:
        self.said.append((time.time(), event.text))

    def __enter__(self) -> Run:
        self._thread.start()
        self.wait(lambda: self.tick > 50)
        return self

    def __exit__(self, *_: object) -> None:
        assert self.swarm.children is not None
        self.swarm.children.members["world"].process.terminate()
        self._thread.join(DEADLINE)

    def wait(self, condition) -> None:  # type: ignore[no-untyped-def]
        deadline = time.monotonic() + DEADLINE
        while not condition():
            if time.monotonic() > deadline:
                raise SystemExit(f"not within {DEADLINE:g} s; the last that was said: {self.said[-3:]}")
            time.sleep(0.002)

    def heard(self, text: str, since: float) -> float:
        """When an event with `text` came after `since`."""
        self.wait(lambda: any(at >= since and text in said for at, said in self.said))
        return next(at for at, said in self.said if at >= since and text in said)

    def process(self, name: str) -> psutil.Process:
        assert self.swarm.children is not None
        return psutil.Process(self.swarm.children.members[name].process.pid)

    def kill(self, name: str) -> float:
        pid = self.process(name).pid
        at = time.time()
        os.kill(pid, signal.SIGKILL)
        return at


def robots(given: argparse.Namespace) -> None:
    rows: dict[str, list[float]] = {"noticed by the world": [], "from the kill": [], "from its start": [], "from ready": []}
    with Run(given.robots, **{"supervision.restart": "always"}) as run:
        assert run.swarm.children is not None
        for n in range(given.count):
            i = n % given.robots
            killed = run.kill(f"robot/{i}")
            drives = run.heard(f"robot {i} drives again", killed)
            sock: Path = run.swarm.children.folder / f"robot-{i}.sock"
            rows["noticed by the world"].append(run.heard(f"robot {i} lost", killed) - killed)
            rows["from the kill"].append(drives - killed)
            rows["from its start"].append(drives - run.heard(f"robot {i} ended with", killed))
            rows["from ready"].append(drives - sock.stat().st_ctime)
            run.wait(lambda: run.live == given.robots)
    report(f"{given.robots} robots, one killed {given.count} times, until the first drive of its new process", rows)


def world(given: argparse.Namespace) -> None:
    rows: dict[str, list[float]] = {"until it is back": [], "until 20 ticks later": []}
    with Run(given.robots, **{"supervision.checkpoint_every": 5.0}) as run:
        for _ in range(given.count):
            tick = run.tick
            run.wait(lambda tick=tick: run.tick > tick + 150)
            killed = run.kill("world")
            back = run.heard("the world is back", killed)
            tick = run.tick
            run.wait(lambda tick=tick: run.tick > tick + 20)
            rows["until it is back"].append(back - killed)
            rows["until 20 ticks later"].append(time.time() - killed)
    report(f"{given.robots} robots, the world killed {given.count} times, a checkpoint every 5 s", rows)


def report(title: str, rows: dict[str, list[float]]) -> None:
    print(title)
    for name, values in rows.items():
        low, high = min(values), max(values)
        print(f"  {name:24} median {statistics.median(values):.3f} s ({low:.3f} to {high:.3f}, n = {len(values)})")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=int, default=5)
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--only", nargs="+", choices=["robots", "world"], default=("robots", "world"))
    given = parser.parse_args()
    for what in given.only:
        {"robots": robots, "world": world}[what](given)


if __name__ == "__main__":
    main()
