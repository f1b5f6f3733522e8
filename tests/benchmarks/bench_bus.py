"""What the bus costs: the swarm's lock-step over `ZenohBus` with its real messages and no maths.

    python tests/benchmarks/bench_bus.py --robots 5 --ticks 2000

One world and N robots on a line, one process each. A tick: the world sends every robot its reading, every robot tells
its neighbours its state, waits for theirs of the same tick, and sends its drive. Prints one JSON line; CPU time and
context switches are those of all processes during the measured ticks.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import tempfile
import time
from pathlib import Path

import psutil

from protocol import keys
from protocol.bus import Delivery, Lost
from protocol.endpoints import free_tcp_endpoints, unix_endpoint
from protocol.messages import Drive, Halt, Reading, Shared
from protocol.zenoh_bus import ZenohBus, token_of

RUN = "bench"
WARM_UP = 50  # ticks


def neighbours_of(i: int, n: int) -> list[int]:
    return [j for j in (i - 1, i + 1) if 0 <= j < n]


def robot(i: int, n: int, endpoints: list[str], lockstep: bool) -> None:
    neighbours = neighbours_of(i, n)
    connect = [endpoints[0], *(endpoints[1 + j] for j in neighbours if j < i)]
    me, here = keys.robot_name(i), endpoints[1 + i]
    bus = ZenohBus(RUN, me, token_of(RUN), listen=[here], connect=connect, lease_ms=5000, lockstep=lockstep)
    bus.subscribe(keys.robot(i, keys.READING), Reading)
    bus.subscribe(keys.HALT, Halt)
    for j in neighbours:
        bus.subscribe(keys.robot(j, keys.SHARED), Shared)
    tell = bus.publisher(keys.robot(i, keys.SHARED), reliable=True)
    drive = bus.publisher(keys.robot(i, keys.DRIVE), reliable=True)
    while not bus.matched(keys.robot(i, keys.SHARED), [keys.robot_name(j) for j in neighbours]):
        time.sleep(0.005)
    early = {0: 0}
    tick, got = -1, 0
    receive = bus.receive
    while True:
        event = receive(None)
        if event.__class__ is not Delivery:
            if event == Lost(keys.WORLD):
                break
            continue
        message = event.message
        kind = message.__class__
        if kind is Reading:
            tick = message.tick
            tell(Shared(i, tick, *[1.5] * 4, *[2.5] * 7, 1, 2, *[3.5] * 4, virtual=(1.0, 2.0, 3.0, 4.0)))
            got = early.pop(tick, 0)
        elif kind is Shared:
            if message.tick == tick:
                got += 1
            else:
                early[message.tick] = early.get(message.tick, 0) + 1
                continue
        else:
            break
        if got == len(neighbours):
            drive(Drive(i, tick, 0.1, 0.2))
    bus.close()


def effort(processes: list[psutil.Process]) -> tuple[float, int]:
    """CPU seconds and context switches so far."""
    times = [p.cpu_times() for p in processes]
    switches = sum(sum(int(x) for x in _switches(p.pid)) for p in processes)
    return sum(t.user + t.system for t in times), switches


def _switches(pid: int) -> list[str]:
    found = []
    for task in Path(f"/proc/{pid}/task").glob("*/status"):
        found += [line.split()[1] for line in task.read_text().splitlines() if "ctxt_switches" in line]
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=int, default=5)
    parser.add_argument("--ticks", type=int, default=2000)
    parser.add_argument("--transport", choices=["unix", "tcp"], default="unix")
    parser.add_argument("--queued", action="store_true", help="links with a thread that sends")
    given = parser.parse_args()
    n = given.robots
    with tempfile.TemporaryDirectory(prefix="odour-") as folder:
        names = [keys.WORLD, *(f"robot-{i}" for i in range(n))]
        if given.transport == "unix":
            endpoints = [unix_endpoint(Path(folder), name) for name in names]
        else:
            endpoints = list(free_tcp_endpoints(n + 1))
        run(n, given.ticks, endpoints, not given.queued)


def run(n: int, ticks: int, endpoints: list[str], lockstep: bool) -> None:
    bus = ZenohBus(RUN, keys.WORLD, token_of(RUN), listen=[endpoints[0]], connect=[], lease_ms=5000, lockstep=lockstep)
    for i in range(n):
        bus.subscribe(keys.robot(i, keys.DRIVE), Drive)
    send = [bus.publisher(keys.robot(i, keys.READING), reliable=True) for i in range(n)]
    halt = bus.publisher(keys.HALT, reliable=True)
    context = multiprocessing.get_context("spawn")
    robots = [context.Process(target=robot, args=(i, n, endpoints, lockstep), daemon=True) for i in range(n)]
    for process in robots:
        process.start()
    while not all(bus.matched(keys.robot(i, keys.READING), [keys.robot_name(i)]) for i in range(n)):
        time.sleep(0.005)
    processes = [psutil.Process(), *(psutil.Process(p.pid) for p in robots)]
    laps: list[float] = []
    cpu, switches = 0.0, 0
    for tick in range(WARM_UP + ticks):
        if tick == WARM_UP:
            cpu, switches = effort(processes)
        start = time.perf_counter()
        for i in range(n):
            hears = tuple((j, tick) for j in neighbours_of(i, n))
            send[i](Reading(i, tick, 0.05 * tick, *[1.5] * 8, hears=hears))
        left = n
        while left:
            left -= bus.receive(None).__class__ is Delivery
        if tick >= WARM_UP:
            laps.append(time.perf_counter() - start)
    cpu_end, switches_end = effort(processes)
    memory = [p.memory_info().rss / 1e6 for p in processes]
    threads = processes[-1].num_threads()
    halt(Halt(ticks, "done"))
    for process in robots:
        process.join(5)
    bus.close()
    laps.sort()
    print(
        json.dumps(
            {
                "robots": n,
                "ticks_per_s": round(ticks / sum(laps), 1),
                "p50_us": round(laps[ticks // 2] * 1e6),
                "p99_us": round(laps[int(ticks * 0.99)] * 1e6),
                "cpu_us_per_tick": round((cpu_end - cpu) / ticks * 1e6),
                "switches_per_tick": round((switches_end - switches) / ticks, 1),
                "mb_world": round(memory[0], 1),
                "mb_robot": round(max(memory[1:]), 1),
                "threads_robot": threads,
            }
        )
    )


if __name__ == "__main__":
    main()
