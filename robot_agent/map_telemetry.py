"""What the recorder is shown of a robot's map of the source: seldom, small, and only when somebody watches.

Rules: nothing here changes a run. A decision's map is `robot_agent.interfaces.BeliefMap`.
"""

from __future__ import annotations

import zlib

from protocol.messages import BeliefMap
from robot_agent.hand import Own
from robot_agent.interfaces import Decision

PERIOD = 2.0  # between two maps, simulated s
LARGEST = 1 << 18  # bytes of a compressed map; a larger one is not shown


def map_message(robot: int, own: Own, decision: Decision) -> BeliefMap | None:
    """The decision's map as it travels; None when there is none to show."""
    shown = decision.belief_map()
    if shown is None:
        return None
    x, y, cell, rows, levels = shown
    packed = zlib.compress(levels, 1)
    return BeliefMap(robot, own.tick, own.t, x, y, cell, rows, packed) if len(packed) <= LARGEST else None
