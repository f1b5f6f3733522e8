"""One random fault, of a kind that is given.

Rules: what is drawn fits a swarm of the given size and edges, and the bounds of `protocol.scenario.faults.check`; when a
robot that stops is free to stop is the schedule's business (`random_schedule`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

from protocol.randomness import Draws
from protocol.scenario.faults import (
    FOREVER,
    Actuator,
    ClockSkew,
    Crash,
    Delay,
    Duplicate,
    Edges,
    Fault,
    Hang,
    Liar,
    Loss,
    Partition,
    Reorder,
    Sensor,
    WorldSlow,
)

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Place:
    """What a fault has to fit."""

    robots: int
    edges: Sequence[tuple[int, int]]
    max_time: float  # s
    longest: float  # s: how late a state may be and still be heard


def random_fault(draws: Draws, kind: str, place: Place) -> Fault:
    """A fault of `kind` that begins within the run; most of them end within it, too."""
    max_time, robots = place.max_time, place.robots
    at = round(draws.uniform() * 0.8 * max_time, 2)
    until = round(at + 0.1 + draws.uniform() * 0.6 * max_time, 2)
    if draws.uniform() < 0.1:
        until = FOREVER
    p = round(draws.uniform(), 2)
    robot = below(draws, robots)
    some = _some(draws, place.edges)
    fault: Fault
    match kind:
        case "crash":
            again = round(0.05 + draws.uniform() * 0.4 * max_time, 2) if draws.uniform() < 0.6 else 0.0
            fault = Crash(at=at, robot=robot, restart=again)
        case "hang":
            fault = Hang(at=at, until=until, robot=robot)
        case "loss":
            fault = Loss(at=at, until=until, edges=some, probability=p)
        case "delay":
            late, jitter = (round(draws.uniform() * place.longest / 2.0, 2) for _ in range(2))
            fault = Delay(at=at, until=until, edges=some, delay=late, jitter=jitter, probability=p)
        case "duplicate":
            fault = Duplicate(at=at, until=until, edges=some, probability=p, after=round(draws.uniform(), 2))
        case "reorder":
            fault = Reorder(at=at, until=until, edges=some, probability=p)
        case "partition":
            fault = Partition(at=at, until=until, groups=_groups(draws, robots), one_way=draws.uniform() < 0.3)
        case "clock-skew":
            drift = round(0.2 * draws.normal(), 3)
            fault = ClockSkew(at=at, until=until, robot=robot, offset=round(5 * draws.normal(), 2), drift=max(-1.0, drift))
        case "sensor":
            which = one(draws, ("concentration", "wind", "position", "heading"))
            how = one(draws, ("stuck", "bias", "dropout", "noise"))
            unit = 3000.0 if which == "concentration" and how != "dropout" else 1.0  # the threshold is some hundreds of ppt
            fault = Sensor(at=at, until=until, robot=robot, which=which, how=how, value=unit * p)  # type: ignore[arg-type]
        case "actuator":
            wheel = one(draws, ("left", "right", "both"))
            fault = Actuator(at=at, until=until, robot=robot, wheel=wheel, strength=p)  # type: ignore[arg-type]
        case "liar":
            lies = one(draws, ("fusion", "detection", "position", "decision"))
            offset = (round(20 * draws.normal(), 1), round(20 * draws.normal(), 1))
            fault = Liar(at=at, until=until, robot=robot, lies=lies, offset=offset, noise=2 * p)  # type: ignore[arg-type]
        case "world-slow":
            fault = WorldSlow(at=at, until=min(until, at + 1.0), pause=0.001 + 0.02 * p)
        case _:
            raise ValueError(f"no draw for a fault of kind {kind!r}")
    return fault


def below(draws: Draws, n: int) -> int:
    """One of 0 to n-1."""
    return int(draws.uniform() * n)


def one(draws: Draws, of: Sequence[T]) -> T:
    """One of several."""
    return of[below(draws, len(of))]


def _some(draws: Draws, edges: Sequence[tuple[int, int]]) -> Edges:
    """All edges (as none) or a part of them."""
    if draws.uniform() < 0.5:
        return ()
    return tuple(edge for edge in edges if draws.uniform() < 0.5)


def _groups(draws: Draws, robots: int) -> tuple[tuple[int, ...], ...]:
    """Two or three groups of any robots; some robots may be in none, which is a group of their own."""
    count = 2 if robots < 4 else 2 + below(draws, 2)
    groups: list[list[int]] = [[] for _ in range(count)]
    for robot in range(robots):
        which = below(draws, count) if draws.uniform() < 0.9 else -1
        if which >= 0:
            groups[which].append(robot)
    return tuple(tuple(group) for group in groups if group) or ((0,),)
