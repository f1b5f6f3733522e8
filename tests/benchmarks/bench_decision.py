"""What a decision of `plume-map` costs one robot: processor time, memory of its process, bytes of events.

    python tests/benchmarks/bench_decision.py time [--gains 0.15 2] [--topologies all ring] [--seeds 5 6 7]
    python tests/benchmarks/bench_decision.py memory [--algorithms plume-map cfpso]
    python tests/benchmarks/bench_decision.py bytes [--loss 0.3] [--robots 5]

`time` plays a swarm in memory and adds up, for every robot and second, the processor time of all that the algorithm does in
the ticks of that second: events taken in and told, the map drawn, mean and covariance, the plan; neither senses nor wheels.
Beside it a yardstick is timed every second, a fixed loop of plain Python: a busy or slow machine stretches both, and
their ratio is what to compare between machines and versions. What the clock itself costs is taken off.
`memory` asks the processes of a swarm over Zenoh how much they hold. `bytes` counts the bytes of events a robot and second.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import psutil

from deploy.memory_run import MemorySwarm
from protocol.scenario import Scenario
from protocol.scenario.load import load_scenario

PARTS = {
    "own event": ("_decision", "record"),
    "events heard": ("_decision", "listen"),
    "events told": ("_decision", "events"),
    "mean": ("_decision", "decide"),
    "brief": ("_planner", "brief"),
    "plan": ("_planner", "plan"),
    "follow": ("_planner", "follow"),
}
GRAPHS = ["all", "ring", "line", "directed-ring"]


def scenario(values: dict[str, Any]) -> Scenario:
    """A run that goes on after the source is reached, until the swarm declares it."""
    chosen = {"algorithm": "plume-map", "declaration.stop": "declared", "declaration.radius": 0.01, **values}
    return load_scenario(None, overrides=[(name, value, "bench") for name, value in chosen.items()])


CELLS = [n << 32 for n in range(10_000)]


def yardstick() -> int:
    """Nanoseconds of a fixed loop, over as much memory as a map has: neighbours on the same processor share its caches."""
    began = time.thread_time_ns()
    for n in range(0, 7919 * 10_000, 7919):
        CELLS[n % 10_000] += n
    return time.thread_time_ns() - began


class Stopwatch:
    """Nanoseconds of one robot's calls, part by part."""

    def __init__(self, agent: object) -> None:
        self.spent = dict.fromkeys(PARTS, 0)
        self.seconds: list[dict[str, int]] = []
        empty = [-self._measure(lambda: None, ())[1] for _ in range(2000)]
        self._empty = -round(statistics.median(empty))
        for part, (owner, name) in PARTS.items():
            self._around(getattr(agent, owner), name, part)

    @staticmethod
    def _measure(call: Callable[..., Any], given: tuple[Any, ...]) -> tuple[Any, int]:
        began = time.thread_time_ns()
        answer = call(*given)
        return answer, time.thread_time_ns() - began

    def _around(self, owner: object, name: str, part: str) -> None:
        plain = getattr(owner, name)

        def timed(*given: Any) -> Any:
            answer, spent = self._measure(plain, given)
            self.spent[part] += spent - self._empty
            return answer

        setattr(owner, name, timed)

    def turn(self) -> None:
        """A second of the run is over."""
        self.seconds.append(dict(self.spent))
        self.spent.update(dict.fromkeys(PARTS, 0))


def play(swarm: MemorySwarm, second: Callable[[], None]) -> None:
    per_second = round(1.0 / swarm.scenario.timing.tick)
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
        if swarm.session.world.tick % per_second == 0:
            second()


def turn(watches: Sequence[Stopwatch], sticks: list[int]) -> None:
    for watch in watches:
        watch.turn()
    sticks.append(yardstick())


def measure_time(given: argparse.Namespace) -> None:
    print("processor time of a decision, per robot and second, ms; ratio: to the yardstick")
    print("gain  graph          median    p95    max   yardstick  ratio p95   of it, medians")
    for gain in given.gains:
        for graph in given.topologies:
            watches: list[Stopwatch] = []
            sticks: list[int] = []
            for seed in given.seeds:
                values = {"wind.gain": gain, "topology": graph, "seed": seed, "case": given.case}
                swarm = MemorySwarm(scenario({**values, "robots": given.robots, "max_time": given.max_time}))
                ours = [Stopwatch(robot.session.agent) for robot in swarm.robots.values()]
                watches += ours

                play(swarm, partial(turn, ours, sticks))
            seconds = [second for watch in watches for second in watch.seconds[1:]]
            totals = sorted(sum(second.values()) / 1e6 for second in seconds)
            p95, stick = totals[round(0.95 * len(totals))], statistics.median(sticks) / 1e6
            middle = statistics.median(totals)
            of_it = ", ".join(f"{part} {statistics.median(s[part] for s in seconds) / 1e6:.2f}" for part in PARTS)
            print(
                f"{gain:4}  {graph:13} {middle:7.3f} {p95:6.3f} {totals[-1]:6.2f}   {stick:9.3f}"
                f"  {middle / stick:5.2f} {p95 / stick:4.2f}   {of_it}",
                flush=True,
            )


def measure_memory(given: argparse.Namespace) -> None:
    for algorithm in given.algorithms:
        run = [sys.executable, "-m", "deploy.cli", "run", "--json", "--algorithm", algorithm, "--robots", str(given.robots)]
        run += ["--topology", "ring", "--set", "wind.gain=2", "--set", "declaration.stop=declared"]
        process = subprocess.Popen([*run, "--max-time", str(given.max_time)], stdout=subprocess.DEVNULL)
        largest: dict[int, float] = {}
        try:
            while process.poll() is None:
                for child in psutil.Process(process.pid).children(recursive=True):
                    try:
                        if "robot_agent" in child.cmdline():
                            largest[child.pid] = max(largest.get(child.pid, 0.0), child.memory_info().rss / 2**20)
                    except psutil.NoSuchProcess:
                        continue
                time.sleep(0.5)
        finally:
            process.terminate()
            process.wait()
        sizes = sorted(largest.values())
        print(f"{algorithm}: {len(sizes)} robot processes, {sizes[0]:.1f} to {sizes[-1]:.1f} MB at most", flush=True)


def measure_bytes(given: argparse.Namespace) -> None:
    print("bytes of events a robot and second, over the run; first second left out")
    for graph in given.topologies:
        for gain in given.gains:
            rates: list[float] = []
            largest = 0.0
            for seed in given.seeds:
                values: dict[str, Any] = {"wind.gain": gain, "topology": graph, "seed": seed, "case": given.case}
                if given.loss:
                    values["faults"] = [{"kind": "loss", "probability": given.loss}]
                swarm = MemorySwarm(scenario({**values, "robots": given.robots, "max_time": given.max_time}))
                sent: dict[int, list[int]] = {}
                for i, robot in swarm.robots.items():
                    decision: Any = robot.session.agent._decision
                    sent[i] = []

                    def counted(own: Any, plain: Any = decision.events, told: list[int] = sent[i]) -> bytes:
                        answer: bytes = plain(own)
                        if own.t >= 1.0:
                            told.append(len(answer))
                        return answer

                    decision.events = counted
                play(swarm, lambda: None)
                duration = swarm.session.world.tick * swarm.scenario.timing.tick - 1.0
                each = [sum(told) / duration for told in sent.values()]
                rates.append(statistics.mean(each))
                largest = max(largest, *each)
            mean = statistics.mean(rates)
            print(f"{graph:13}  gain {gain:4}  mean {mean:6.1f} B/s, busiest robot {largest:6.1f} B/s", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["time", "memory", "bytes"])
    parser.add_argument("--robots", type=int, default=5)
    parser.add_argument("--case", type=int, default=1)
    parser.add_argument("--gains", nargs="+", type=float, default=[0.15, 2.0])
    parser.add_argument("--topologies", nargs="+", default=GRAPHS)
    parser.add_argument("--seeds", nargs="+", type=int, default=[5])
    parser.add_argument("--max-time", type=float, default=200.0)
    parser.add_argument("--loss", type=float, default=0.0)
    parser.add_argument("--algorithms", nargs="+", default=["plume-map", "cfpso"])
    given = parser.parse_args()
    {"time": measure_time, "memory": measure_memory, "bytes": measure_bytes}[given.what](given)


if __name__ == "__main__":
    main()
