"""A member's place in the swarm: what it may know, and where it finds the others."""

from __future__ import annotations

from protocol.scenario.scenario import RobotScenario, Scenario, robot_view
from protocol.scenario.table import Table


class RobotPlace(Table, frozen=True):
    """All that a robot process is given."""

    scenario: RobotScenario
    world: str  # endpoint of the world
    robots: dict[int, str]  # endpoints of this robot and of those it is linked to


class WorldPlace(Table, frozen=True):
    """All that a world process is given."""

    scenario: Scenario
    endpoints: tuple[str, ...]  # the world's, then each robot's


def place_of(scenario: Scenario, i: int, endpoints: tuple[str, ...]) -> RobotPlace:
    """Place of robot `i`; `endpoints` are the world's and then each robot's."""
    view = robot_view(scenario, i)
    return RobotPlace(view, endpoints[0], {j: endpoints[1 + j] for j in (i, *view.linked)})
