"""Random fault schedules: any kinds, any number, any swarm; the same number gives the same schedule.

Rules: every schedule is a scenario that `check` accepts; draws are addressed ("schedule", number). Robots start near the
plume, so that a few simulated seconds hold search, detection and tracing.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

from protocol.randomness import Draws, rng_for
from protocol.scenario import Scenario
from protocol.scenario.faults import (
    KINDS,
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
from protocol.scenario.load import load_scenario

TOPOLOGIES = ("all", "ring", "line", "star")
ALGORITHMS = ("cfpso", "dcs", "simple")
MOST = 10  # faults in a schedule
NEAR = {"start.x": 60.0, "start.y": -6.0, "plume.warm_up": 120.0}  # the swarm meets the odour within seconds

T = TypeVar("T")


def random_scenario(number: int, max_time: float = 8.0) -> Scenario:
    """Scenario `number`: 2 to 7 robots, 1 to `MOST` faults within `max_time` simulated seconds."""
    draws = rng_for(number, "schedule")
    robots = 2 + _below(draws, 6)
    values: dict[str, object] = {
        **NEAR,
        "robots": robots,
        "topology": _one(draws, TOPOLOGIES),
        "algorithm": _one(draws, ALGORITHMS),
        "seed": number,
        "max_time": max_time,
    }
    bare = load_scenario(None, overrides=_given(values))
    edges = [(i, j) for i, j, _ in bare.graph]
    faults: list[Fault] = []
    stopped: set[int] = set()
    kinds = list(KINDS)
    for _ in range(1 + _below(draws, MOST)):
        kind = _one(draws, kinds)
        if kind in ("crash", "hang"):
            free = [i for i in range(robots) if i not in stopped]
            if not free:
                continue
            robot = _one(draws, free)
            stopped.add(robot)
        else:
            robot = _below(draws, robots)
        faults.append(_fault(draws, kind, robot, robots, edges, max_time))
    return load_scenario(None, overrides=_given({**values, "faults": tuple(faults)}))


def _fault(
    draws: Draws, kind: str, robot: int, robots: int, edges: Sequence[tuple[int, int]], max_time: float
) -> Fault:
    at = round(draws.uniform() * 0.8 * max_time, 2)
    until = round(at + 0.1 + draws.uniform() * 0.6 * max_time, 2)
    p = round(draws.uniform(), 2)
    some = _some(draws, edges)
    fault: Fault
    match kind:
        case "crash":
            fault = Crash(at=at, robot=robot)
        case "hang":
            fault = Hang(at=at, until=until, robot=robot)
        case "loss":
            fault = Loss(at=at, until=until, edges=some, probability=p)
        case "delay":
            late, jitter = round(draws.uniform(), 2), round(draws.uniform(), 2)
            fault = Delay(at=at, until=until, edges=some, delay=late, jitter=jitter, probability=p)
        case "duplicate":
            fault = Duplicate(at=at, until=until, edges=some, probability=p, after=round(draws.uniform(), 2))
        case "reorder":
            fault = Reorder(at=at, until=until, edges=some, probability=p)
        case "partition":
            cut = 1 + _below(draws, max(1, robots - 1))
            groups = (tuple(range(cut)), tuple(range(cut, robots)))
            fault = Partition(at=at, until=until, groups=groups, one_way=draws.uniform() < 0.3)
        case "clock-skew":
            drift = round(0.2 * draws.normal(), 3)
            fault = ClockSkew(at=at, until=until, robot=robot, offset=round(5 * draws.normal(), 2), drift=max(-1.0, drift))
        case "sensor":
            which = _one(draws, ("concentration", "wind", "position", "heading"))
            how = _one(draws, ("stuck", "bias", "dropout", "noise"))
            fault = Sensor(at=at, until=until, robot=robot, which=which, how=how, value=p)  # type: ignore[arg-type]
        case "actuator":
            wheel = _one(draws, ("left", "right", "both"))
            fault = Actuator(at=at, until=until, robot=robot, wheel=wheel, strength=p)  # type: ignore[arg-type]
        case "liar":
            lies = _one(draws, ("fusion", "detection", "position", "decision"))
            offset = (round(20 * draws.normal(), 1), round(20 * draws.normal(), 1))
            fault = Liar(at=at, until=until, robot=robot, lies=lies, offset=offset, noise=2 * p)  # type: ignore[arg-type]
        case "world-slow":
            fault = WorldSlow(at=at, until=min(until, at + 1.0), pause=0.001 + 0.02 * p)
        case _:
            raise ValueError(f"no draw for a fault of kind {kind!r}")
    return fault


def _below(draws: Draws, n: int) -> int:
    return int(draws.uniform() * n)


def _one(draws: Draws, of: Sequence[T]) -> T:
    return of[_below(draws, len(of))]


def _some(draws: Draws, edges: Sequence[tuple[int, int]]) -> Edges:
    """All edges (as none) or a part of them."""
    if draws.uniform() < 0.5:
        return ()
    return tuple(edge for edge in edges if draws.uniform() < 0.5)


def _given(values: dict[str, object]) -> list[tuple[str, object, str]]:
    return [(name, value, "schedule") for name, value in values.items()]
