"""Faults that do not fit the swarm or each other.

Rules: as in `protocol.scenario.check`: one sentence or nothing, without its place.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from protocol.scenario.faults import (
    HISTORY,
    Actuator,
    ClockSkew,
    Crash,
    Delay,
    Duplicate,
    Fault,
    Hang,
    Liar,
    OnEdges,
    Partition,
    Sensor,
)

OfRobot = Crash | Hang | Sensor | Actuator | Liar | ClockSkew


def faults_in(
    faults: tuple[Fault, ...], robots: int, edges: Collection[tuple[int, int]], tick: float
) -> Iterator[tuple[str, tuple[str, ...]]]:
    """What is wrong with `faults`, and the scenario's values that each sentence is about.

    Args:
        edges: (i, j) of the graph.
        tick: control period, s.
    """
    for n, fault in enumerate(faults, 1):
        name = f"[[faults]] {n} ({fault.__struct_config__.tag})"
        if fault.end <= fault.at:
            yield f"{name}: until is {fault.end:g}; it must be greater than at, which is {fault.at:g}.", ("faults",)
        if isinstance(fault, OfRobot) and fault.robot >= robots:
            yield _no_robot(name, "robot", fault.robot, robots)
        if isinstance(fault, OnEdges):
            yield from _edges(name, fault, robots, edges)
        if isinstance(fault, Delay | Duplicate):
            yield from _too_late(name, fault, tick)
        if isinstance(fault, Partition):
            yield from _groups(name, fault, robots)
        if isinstance(fault, Sensor) and fault.how in ("dropout", "noise"):
            most = 1.0 if fault.how == "dropout" else 1e9
            if not 0.0 <= fault.strength <= most:
                bounds = "from 0 to 1" if fault.how == "dropout" else ">= 0"
                yield f'{name}: value is {fault.strength:g}; with how = "{fault.how}" it must be {bounds}.', ("faults",)
    yield from _overlaps(faults)


def _edges(
    name: str, fault: OnEdges, robots: int, edges: Collection[tuple[int, int]]
) -> Iterator[tuple[str, tuple[str, ...]]]:
    for i, j in fault.edges:
        if max(i, j) >= robots:
            yield _no_robot(name, "edges", max(i, j), robots)
        elif (i, j) not in edges:
            yield (
                f"{name}: robot {i} does not hear robot {j}; [{i}, {j}] must be an edge of the graph, or leave edges out"
                " for all of them.",
                ("faults", "topology", "graph"),
            )


def _too_late(name: str, fault: Delay | Duplicate, tick: float) -> Iterator[tuple[str, tuple[str, ...]]]:
    late = fault.delay + fault.jitter if isinstance(fault, Delay) else fault.after
    most = (HISTORY - 2) * tick
    if late > most + 1e-9:
        values = "delay plus jitter" if isinstance(fault, Delay) else "after"
        yield (
            f"{name}: {values} is {late:g} s; it must be at most {most:g} s, for a robot keeps its neighbours' states for"
            f" {HISTORY} ticks of {tick:g} s.",
            ("faults", "timing.tick"),
        )


def _groups(name: str, fault: Partition, robots: int) -> Iterator[tuple[str, tuple[str, ...]]]:
    members = [robot for group in fault.groups for robot in group]
    if not members:
        yield f"{name}: groups is empty; it must have at least one group, for example [[0, 1], [2, 3, 4]].", ("faults",)
    for robot in members:
        if robot >= robots:
            yield _no_robot(name, "groups", robot, robots)
        if members.count(robot) > 1:
            yield f"{name}: robot {robot} is in two groups; it must be in one.", ("faults",)


def _overlaps(faults: tuple[Fault, ...]) -> Iterator[tuple[str, tuple[str, ...]]]:
    """A robot that has crashed cannot hang, and one that hangs cannot hang again."""
    stops = [(n, fault) for n, fault in enumerate(faults, 1) if isinstance(fault, Crash | Hang)]
    for m, (n, later) in enumerate(stops):
        for k, earlier in stops[:m]:
            if stopped_twice(earlier, later):
                yield (
                    f"[[faults]] {k} and {n} stop robot {later.robot} at the same time, from {earlier.at:g} s"
                    f" and from {later.at:g} s; the second must begin after the first is over.",
                    ("faults",),
                )


def stopped_twice(one: Crash | Hang, other: Crash | Hang) -> bool:
    """Whether both stop the same robot at the same time."""
    return one.robot == other.robot and other.at < _back(one) and one.at < _back(other)


def _back(fault: Crash | Hang) -> float:
    """When the robot takes part again at the earliest, s."""
    if isinstance(fault, Crash):
        return fault.at + fault.restart if fault.restart else fault.end
    return fault.until


def _no_robot(name: str, value: str, robot: int, robots: int) -> tuple[str, tuple[str, ...]]:
    given = f"robot is {robot}" if value == "robot" else f"{value} names robot {robot}"
    return f"{name}: {given}; it must be from 0 to {robots - 1}.", ("faults", "robots")
