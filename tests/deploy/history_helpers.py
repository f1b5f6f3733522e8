"""True histories for tests, and how they are tampered with."""

from __future__ import annotations

import copy
from collections.abc import Callable

from msgspec.structs import replace

from deploy.checkers.check import CHECKERS, History, check_run, read_memory
from deploy.checkers.finding import Finding
from deploy.memory_run import MemorySwarm, run_in_memory
from protocol.history.file import HistoryMemory
from protocol.messages import Outcome
from protocol.scenario import Scenario
from world_server.outcome import outcome


def kept(scenario: Scenario, *, wire: bool = False) -> tuple[History, Outcome]:
    """A run in memory and its history."""
    memory = HistoryMemory()
    ended = run_in_memory(scenario, wire=wire, history=memory)
    return read_memory(memory), ended


def kept_with_death(scenario: Scenario, robot: int, tick: int) -> History:
    """The history of a run in which `robot` is killed at `tick`."""
    memory = HistoryMemory()
    swarm = MemorySwarm(scenario, history=memory)
    swarm.start()
    while not swarm.session.over:
        if swarm.session.world.tick == tick and swarm.robots[robot].alive:
            swarm.kill(robot)
        swarm.tick()
    swarm.history.result(outcome(swarm.session, "memory", 1.0, swarm.bus.counters))
    return read_memory(memory)


def broken(history: History) -> dict[str, str]:
    """The counter-examples by checker."""
    return {f.name: f.counterexample for f in check_run(history) if f.counterexample is not None}


def look(name: str, history: History) -> Finding:
    """What one checker says."""
    return next(checker for checker in CHECKERS if checker.name == name).look(history)


def tampered(history: History, tamper: Callable[[History], None]) -> History:
    """A copy of `history` after `tamper`."""
    mine = copy.deepcopy(history)
    tamper(mine)
    return mine


def change_act(history: History, robot: int, tick: int, **changes: object) -> None:
    """Write other fields into what `robot` did at `tick`."""
    _change(history.lives[robot][0].acted, tick, changes)


def change_moved(history: History, tick: int, **changes: object) -> None:
    """Write other fields into what the world did at `tick`."""
    _change(history.moved, tick, changes)


def _change(records: list, tick: int, changes: dict[str, object]) -> None:
    n = next(n for n, record in enumerate(records) if record.tick == tick)
    records[n] = replace(records[n], **changes)
