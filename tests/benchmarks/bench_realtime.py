"""Real time: missed control periods, and how soon neighbours see a crash, a hang and a return.

    python tests/benchmarks/bench_realtime.py --robots 20 --seconds 60
    python tests/benchmarks/bench_realtime.py --robots 20 --seconds 60 --only plain frozen

`plain`: nobody fails. `frozen`: one robot is stopped (SIGSTOP) for a third of the time; what do the others miss? `hangs`:
one after the other is stopped for a second; when do its neighbours on the ring lose and see it? `crashes`: every second
robot is killed, one after the other. Speed 1, the control period of the scenario (20 Hz); robots are the real processes,
and what a robot sees is stamped in the robot's own process by the clock that all processes of a machine share.
"""

from __future__ import annotations

import argparse
import os
import signal
import statistics
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import psutil
from rich.console import Console
from rich.table import Table

import deploy.launch.swarm as launch
from deploy.launch.children import Child, Children
from deploy.launch.swarm import SwarmRun
from protocol.messages import Event, Outcome, Progress
from protocol.scenario.load import load_scenario

STAMPS = "BENCH_STAMPS"  # folder into which robots write what they see
START = 3.0  # simulated s before anything is done to anybody
HANG, REST = 1.0, 1.0  # s


def robot(arguments: Sequence[str]) -> int:
    """Be a robot that stamps what it says."""
    import msgspec

    from protocol.scenario.place import RobotPlace
    from protocol.shell import serve_until_done
    from robot_agent.process import RobotProcess

    place = Path(arguments[arguments.index("--place") + 1])
    view = msgspec.json.decode(place.read_bytes(), type=RobotPlace)
    with (Path(os.environ[STAMPS]) / str(view.scenario.robot)).open("w", buffering=1) as file:
        member = RobotProcess(
            arguments[arguments.index("--run") + 1], view, say=lambda text: print(time.monotonic(), text, file=file)
        )
        return serve_until_done(member.serve, leash=True, folder=place.parent)


class Stamping(Children):
    """Starts robots that stamp what they say."""

    def start(self, name: str, module: str, arguments: Sequence[str]) -> Child:
        if module == "robot_agent":
            return super().start(name, Path(__file__).stem, ["robot", *arguments])
        return super().start(name, module, arguments)


class Run:
    """One run in a thread, and a hand that does something to its processes."""

    def __init__(self, robots: int, seconds: float, topology: str = "ring") -> None:
        values = {"robots": robots, "topology": topology, "max_time": seconds, "clock": "realtime", "source.y": 49.0}
        self.swarm = SwarmRun("bench", load_scenario(None, overrides=[(k, v, "bench") for k, v in values.items()]))
        self.seconds = seconds
        self.t = 0.0
        self.over = threading.Event()
        self.outcome: Outcome | None = None
        self.cpu = 0.0  # s of all processes, from START on
        self.seen: list[tuple[int, float, str]] = []  # who, when, what

    def progress(self, progress: Progress) -> None:
        self.t = progress.t

    def event(self, event: Event) -> None:
        """What neighbours see is of interest, not what the world sees."""

    def pid(self, i: int) -> int:
        assert self.swarm.children is not None
        return self.swarm.children.members[f"robot/{i}"].process.pid

    def at(self, t: float) -> bool:
        """Wait for simulated time `t`; whether the run goes on."""
        while self.t < t and not self.over.is_set():
            time.sleep(0.005)
        return not self.over.is_set()

    def execute(self, hand: Callable[[Run], None] | None = None) -> Run:
        with tempfile.TemporaryDirectory(prefix="bench-") as folder:
            os.environ[STAMPS] = folder
            thread = threading.Thread(target=self._run)
            thread.start()
            self.at(START)
            before = self._cpu()
            if hand is not None:
                hand(self)
            self.at(self.seconds - 0.5)
            self.cpu = self._cpu() - before
            thread.join()
            for file in Path(folder).iterdir():
                for line in file.read_text().splitlines():
                    when, text = line.split(" ", 1)
                    self.seen.append((int(file.name), float(when), text))
        return self

    def _run(self) -> None:
        try:
            self.outcome = self.swarm.execute(self)
        finally:
            self.over.set()

    def _cpu(self) -> float:
        assert self.swarm.children is not None
        total = 0.0
        for child in self.swarm.children.members.values():
            if child.status is None:
                times = psutil.Process(child.process.pid).cpu_times()
                total += times.user + times.system
        return total

    def delays(self, robot: int, text: str, since: float) -> list[float]:
        """How long after `since` each neighbour first said `text` of `robot`, s."""
        first: dict[int, float] = {}
        for who, when, what in sorted(self.seen, key=lambda each: each[1]):
            if what == f"robot/{robot} {text}" and who != robot and when >= since:
                first.setdefault(who, when - since)
        return list(first.values())


def plain(robots: int, seconds: float, topology: str, rows: Table) -> None:
    run = Run(robots, seconds, topology).execute()
    outcome = run.outcome
    assert outcome is not None
    rows.add_row("missed periods, nobody fails", _missed(outcome, range(robots)))
    rows.add_row("  world behind at most / given up", f"{1e3 * outcome.behind:.1f} / {1e3 * outcome.slip:.1f} ms")
    rows.add_row("  processors in use", f"{run.cpu / (seconds - START - 0.5):.2f}")


def frozen(robots: int, seconds: float, topology: str, rows: Table) -> None:
    def freeze(run: Run) -> None:
        os.kill(run.pid(1), signal.SIGSTOP)
        run.at(START + seconds / 3)
        os.kill(run.pid(1), signal.SIGCONT)

    outcome = Run(robots, seconds, topology).execute(freeze).outcome
    assert outcome is not None
    rows.add_row("missed periods of the others, one frozen", _missed(outcome, [i for i in range(robots) if i != 1]))
    rows.add_row("  of the frozen one, until it was lost", str(outcome.missed[1]))
    rows.add_row("  world behind at most / given up", f"{1e3 * outcome.behind:.1f} / {1e3 * outcome.slip:.1f} ms")


def hangs(robots: int, count: int, rows: Table) -> None:
    stops: list[tuple[int, float, float]] = []

    def stop_each(run: Run) -> None:
        for n in range(count):
            i = n % robots
            stopped = time.monotonic()
            os.kill(run.pid(i), signal.SIGSTOP)
            time.sleep(HANG)
            stops.append((i, stopped, time.monotonic()))
            os.kill(run.pid(i), signal.SIGCONT)
            time.sleep(REST)

    run = Run(robots, START + count * (HANG + REST + 0.1) + 2.0).execute(stop_each)
    rows.add_row("hang seen by neighbours", _times([d for i, s, _ in stops for d in run.delays(i, "is lost", s)]))
    rows.add_row("return seen by neighbours", _times([d for i, _, c in stops for d in run.delays(i, "is there", c)]))


def crashes(robots: int, count: int, rows: Table) -> None:
    found: list[float] = []
    while len(found) < 2 * count:
        kills: list[tuple[int, float]] = []

        def kill_each(run: Run, kills: list[tuple[int, float]] = kills) -> None:
            for i in range(0, robots - 1, 2):
                kills.append((i, time.monotonic()))
                os.kill(run.pid(i), signal.SIGKILL)
                time.sleep(0.3)

        run = Run(robots, START + robots * 0.2 + 2.0).execute(kill_each)
        found += [d for i, t in kills for d in run.delays(i, "is lost", t)]
    rows.add_row("crash seen by neighbours", _times(found))


def _missed(outcome: Outcome, robots: Sequence[int] | range) -> str:
    missed = [outcome.missed[i] for i in robots]
    return f"{sum(missed)} of {len(missed) * outcome.ticks} (worst robot {max(missed)})"


def _times(found: list[float]) -> str:
    if not found:
        return "never"
    found.sort()
    return (
        f"median {1e3 * statistics.median(found):.1f} ms, 95 % {1e3 * found[int(0.95 * len(found))]:.1f}, "
        f"largest {1e3 * found[-1]:.1f} (n = {len(found)})"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--count", type=int, default=50, help="hangs, and crashes")
    parser.add_argument("--topology", default="ring")
    parser.add_argument("--only", nargs="+", choices=["plain", "frozen", "hangs", "crashes"], default=())
    given = parser.parse_args()
    os.environ["PYTHONPATH"] = os.pathsep.join([str(Path(__file__).parent), *sys.path[1:]])
    launch.Children = Stamping  # type: ignore[misc]
    rows = Table("what", "measured", title=f"{given.robots} robots at 20 Hz, speed 1, {os.cpu_count()} processors")
    for what in given.only or ("plain", "frozen", "hangs", "crashes"):
        if what == "plain":
            plain(given.robots, given.seconds, given.topology, rows)
        elif what == "frozen":
            frozen(given.robots, given.seconds, given.topology, rows)
        elif what == "hangs":
            hangs(given.robots, given.count, rows)
        else:
            crashes(given.robots, given.count, rows)
    load = os.getloadavg()[0]
    rows.add_row("load of the machine at the end", f"{load:.1f}")
    Console(width=110).print(rows)


if __name__ == "__main__":
    if sys.argv[1:2] == ["robot"]:
        from protocol.shell import leave

        leave(robot(sys.argv[2:]))
    main()
