"""Which robots' processes stand still: what a person, a debugger or a planned hang has stopped (SIGSTOP).

Rules: it looks at the processes and at nothing they say. A link that is silent proves nothing on a busy machine, so links
are given time (`network.lease_ms`); that a process is stopped the system knows at once, and the launcher tells the world.
A process is stopped when it was so at two looks, EVERY apart: one that is stopped and let go together with the launcher,
as by Ctrl-Z and `fg`, is not. What was seen before the launcher itself was held up does not count.
Time comes in as an argument.
"""

from __future__ import annotations

from collections.abc import Callable, Container
from contextlib import suppress
from dataclasses import dataclass, field

import psutil

from deploy.launch.children import Child, Children
from protocol import keys
from protocol.messages import Stopped

EVERY = 0.08  # s between two looks
HELD_UP = 0.5  # s without a look: the launcher was stopped, or starved


@dataclass(slots=True)
class Standstill:
    """The robots of one run."""

    children: Children
    tell: Callable[[Stopped], None]
    planned: Container[str]  # members whose standstill the world has ordered and knows of
    _still: set[str] = field(default_factory=set)  # at the last look
    _told: set[str] = field(default_factory=set)
    _next: float = 0.0

    def look(self, now: float) -> None:
        """Tell who has stopped and who goes on."""
        if now < self._next:
            return
        if now > self._next + HELD_UP:
            self._still.clear()
        self._next = now + EVERY
        for name, child in self.children.members.items():
            robot = keys.robot_of(name)
            if robot is None or name in self.planned:
                continue
            if not is_stopped(child):
                self._still.discard(name)
                if name in self._told:
                    self._told.discard(name)
                    if child.status is None:
                        self.tell(Stopped(robot, False))
            elif name not in self._still:
                self._still.add(name)
            elif name not in self._told:
                self._told.add(name)
                self.tell(Stopped(robot, True))


def is_stopped(child: Child) -> bool:
    """Whether a process is there and stands still."""
    with suppress(psutil.Error):
        return child.status is None and psutil.Process(child.process.pid).status() == psutil.STATUS_STOPPED
    return False
