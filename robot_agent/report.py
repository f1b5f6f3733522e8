"""A robot's last word to the world."""

from __future__ import annotations

from protocol.bus import Counters
from protocol.messages import Report
from robot_agent.realtime_session import RealtimeRobotSession
from robot_agent.session import RobotSession


def report(session: RobotSession | RealtimeRobotSession, counters: Counters) -> Report:
    """Final decision and counters."""
    estimate = session.agent.estimate
    h_x, h_y = estimate or (0.0, 0.0)
    return Report(
        session.agent.robot,
        h_x,
        h_y,
        estimate is not None,
        counters.sent,
        counters.received,
        counters.dropped + session.dropped,
        counters.refused + session.agent.validation.total,
    )
