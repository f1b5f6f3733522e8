"""Scenario files: their tables, how they are read and checked, presets, and what a robot may know of them."""

from protocol.scenario.scenario import (
    RobotScenario,
    Scenario,
    lease_ms,
    linked_to,
    proximity,
    robot_view,
    scenario_digest,
)
from protocol.scenario.stage import Edge, Stage

__all__ = ["Edge", "RobotScenario", "Scenario", "Stage", "lease_ms", "linked_to", "proximity", "robot_view",
           "scenario_digest"]  # fmt: skip
