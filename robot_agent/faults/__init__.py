"""What a robot gets wrong itself: its clock, and what it tells. It acts these out, so that false bytes are on real wires.

Rules: pure; a robot knows no faults but its own (`RobotScenario.faults`); one without them pays nothing.
"""

from __future__ import annotations

from collections.abc import Callable

from protocol.messages import Reading, Shared
from protocol.scenario.faults import ClockSkew
from robot_agent.agent import Agent
from robot_agent.faults.clock_skew import believed
from robot_agent.faults.liar import told


def false_sense(agent: Agent) -> Callable[[Reading], Shared]:
    """`agent.sense`, or what takes its place when the robot has faults of its own."""
    scenario = agent.scenario
    if not scenario.faults:
        return agent.sense
    dt = scenario.timing.tick
    faults = [(n, *fault.ticks(dt), fault) for n, fault in enumerate(scenario.faults)]

    def sense(reading: Reading) -> Shared:
        t = reading.t
        now = [(n, fault) for n, first, end, fault in faults if first <= reading.tick < end]
        for _, fault in now:
            if isinstance(fault, ClockSkew):
                reading = believed(reading, fault, t)
        state = agent.sense(reading)
        for n, fault in now:
            if not isinstance(fault, ClockSkew):
                state = told(state, reading, fault, n, scenario.seed)
        return state

    return sense
