"""The algorithms by name: which decision, planner and controller make each.

A new algorithm is one new file for what is new in it, and one line here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from protocol.errors import ScenarioError
from protocol.scenario import RobotScenario
from robot_agent.control.cfpso import CfpsoControl
from robot_agent.control.dcs import DcsControl
from robot_agent.control.simple import SimpleControl
from robot_agent.decision.dda import DistributedDecision
from robot_agent.interfaces import Controller, Decision, Planner
from robot_agent.planning.trace import TracePlanner


@dataclass(frozen=True, slots=True)
class Algorithm:
    """The parts of an algorithm, each made from a robot's scenario."""

    title: str
    decision: Callable[[RobotScenario], Decision]
    planner: Callable[[RobotScenario], Planner]
    controller: Callable[[RobotScenario], Controller]
    at_once: bool = False  # begins at the start, not at the first detection: no common search goes before it


ALGORITHMS: dict[str, Algorithm] = {
    "simple": Algorithm("DDA with (3.34)+(3.35), chapter 3", DistributedDecision, TracePlanner, SimpleControl),
    "cfpso": Algorithm("DDA with the PSO-based law (4.12)", DistributedDecision, TracePlanner, CfpsoControl),
    "dcs": Algorithm("DDA with the consensus-based laws (5.5), (5.7)", DistributedDecision, TracePlanner, DcsControl),
}


def algorithm(name: str) -> Algorithm:
    """The algorithm called `name`."""
    try:
        return ALGORITHMS[name]
    except KeyError:
        raise ScenarioError(f"algorithm is {name!r}; it must be one of {', '.join(ALGORITHMS)}.") from None
