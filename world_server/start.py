"""How the robots stand at t = 0."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from protocol.scenario import Scenario
from protocol.scenario.start import start_points


def start_poses(scenario: Scenario) -> NDArray[np.float64]:
    """Centre poses (x, y, theta) of all robots, shape (N, 3), m and rad: `start_points`, and `start.headings` when given,
    otherwise all heading `start.heading`."""
    poses = np.empty((scenario.robots, 3))
    poses[:, :2] = start_points(scenario)
    poses[:, 2] = scenario.start.headings or scenario.start.heading
    return poses
