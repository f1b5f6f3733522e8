"""Random fault schedules: any kinds, any number, any swarm; the same number gives the same schedule.

Rules: every schedule is a scenario that `check` accepts, and that a file can hold (`dump_toml`); the swarm is drawn apart
from what goes wrong with it (`random_swarm`, `random_fault`).
"""

from __future__ import annotations

from collections.abc import Mapping

from deploy.faults.random_fault import Place, below, one, random_fault
from deploy.faults.random_swarm import random_swarm
from protocol.randomness import rng_for
from protocol.scenario import Scenario
from protocol.scenario.faults import HISTORY, KINDS, Crash, Fault, Hang
from protocol.scenario.faults.check import stopped_twice
from protocol.scenario.load import load_scenario
from robot_agent.algorithms import ALGORITHMS

MOST = 10  # faults in a schedule


def random_scenario(number: int, max_time: float = 8.0) -> Scenario:
    """Scenario `number`: 2 to 9 robots, 1 to `MOST` faults within `max_time` simulated seconds."""
    swarm = random_swarm(number, max_time)
    bare = load_scenario(None, overrides=_given(swarm), algorithms=ALGORITHMS)
    faults = _faults(number, Place(bare.robots, [(i, j) for i, j, _ in bare.graph], max_time, _longest(bare)))
    return load_scenario(None, overrides=_given({**swarm, "faults": faults}), algorithms=ALGORITHMS)


def _faults(number: int, place: Place) -> tuple[Fault, ...]:
    draws = rng_for(number, "schedule", "faults")
    faults: list[Fault] = []
    for n in range(1 + below(draws, MOST)):
        fault = random_fault(rng_for(number, "schedule", "fault", n), one(draws, tuple(KINDS)), place)
        stops = [each for each in faults if isinstance(each, Crash | Hang)]
        if not (isinstance(fault, Crash | Hang) and any(stopped_twice(each, fault) for each in stops)):
            faults.append(fault)
    return tuple(faults)


def _longest(scenario: Scenario) -> float:
    """How late a state may be, s."""
    return (HISTORY - 2) * scenario.timing.tick


def _given(values: Mapping[str, object]) -> list[tuple[str, object, str]]:
    return [(name, value, "schedule") for name, value in values.items()]
