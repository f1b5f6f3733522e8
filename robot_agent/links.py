"""Which neighbours are linked now, as one robot tells the world.

Rules: pure; it begins with all declared ones, for without them no robot joins; a change is told once, and everything
again when the world was gone in between or asks.
"""

from __future__ import annotations

from collections.abc import Callable

from protocol.messages import Linked, Resume
from robot_agent.session import RobotSession


class Links:
    """One robot's neighbours."""

    def __init__(self, session: RobotSession, declared: tuple[int, ...], tell: Callable[[Linked], None]) -> None:
        self._session = session
        self._there = set(declared)
        self._tell = tell

    def lost(self, robot: int) -> None:
        """The link with `robot` is down."""
        self._session.lose(robot)
        if robot in self._there:
            self._there.discard(robot)
            self.say()

    def seen(self, robot: int) -> None:
        """The link with `robot` is up."""
        self._session.see(robot)
        if robot not in self._there:
            self._there.add(robot)
            self.say()

    def resume(self, order: Resume) -> None:
        """The world wants this robot to take part again."""
        self._session.resume(order.tick)
        self.say(order.tick)

    def say(self, answer_to: int = -1) -> None:
        """Tell the world who is there."""
        self._tell(Linked(self._session.agent.robot, answer_to, tuple(sorted(self._there))))
