"""A clock that is wrong: the robot believes, and tells, another time than it is."""

from __future__ import annotations

import msgspec

from protocol.messages import Reading
from protocol.scenario.faults import ClockSkew


def believed(reading: Reading, fault: ClockSkew, t: float) -> Reading:
    """`reading` with the time that the robot's clock shows at time `t`: never before the start of the run."""
    return msgspec.structs.replace(reading, t=max(0.0, reading.t + fault.offset + fault.drift * (t - fault.at)))
