"""Where the robots stand at t = 0."""

from __future__ import annotations

from protocol.scenario.scenario import Scenario, robots_per_column
from protocol.scenario.table import Point


def start_points(scenario: Scenario) -> tuple[Point, ...]:
    """Centres of all robots, m.

    `start.positions` when given; otherwise a column from (start.x, start.y) upwards, `start.spacing` apart. The thesis
    says "right-up corner" only; the column is a reading (docs/departures.md). More robots than the arena is high fill
    further columns, away from the edge.
    """
    start = scenario.start
    if start.positions:
        return start.positions
    per_column = robots_per_column(scenario)
    return tuple(
        (start.x - start.spacing * (i // per_column), start.y + start.spacing * (i % per_column))
        for i in range(scenario.robots)
    )
