"""Where the robots stand at t = 0."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from protocol.scenario import Scenario
from protocol.scenario.scenario import robots_per_column


def start_poses(scenario: Scenario) -> NDArray[np.float64]:
    """Centre poses (x, y, theta) of all robots, shape (N, 3), m and rad.

    `start.positions` and `start.headings` when given; otherwise a column from (start.x, start.y) upwards,
    `start.spacing` apart, all heading `start.heading`. The thesis says "right-up corner" only; the column is a reading
    (docs/departures.md). More robots than the arena is high fill further columns, away from the edge.
    """
    start, n = scenario.start, scenario.robots
    poses = np.empty((n, 3))
    poses[:, 2] = start.headings or start.heading
    if start.positions:
        poses[:, :2] = start.positions
        return poses
    per_column = robots_per_column(scenario)
    i = np.arange(n)
    poses[:, 0] = start.x - start.spacing * (i // per_column)
    poses[:, 1] = start.y + start.spacing * (i % per_column)
    return poses
