"""The parallel motion of chapter 5 alone: a formation that follows v_c and never circles."""

from __future__ import annotations

from msgspec.structs import replace

from protocol.scenario import RobotScenario
from robot_agent.control.dcs import DcsControl


def formation_control(scenario: RobotScenario) -> DcsControl:
    """(5.5) for plans that are never lost; `dcs.order` chooses between (5.5) and (5.7) and has nothing to choose here."""
    return DcsControl(replace(scenario, dcs=replace(scenario.dcs, order="algorithm-5")))
