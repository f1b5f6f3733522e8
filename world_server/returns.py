"""When a robot that was called back is let in, or given up: the wall clock's part in a planned hang.

Rules: part of the shell. A robot that was stopped for longer than half a lease may be about to lose links that both of
its ends still believe in: it is let in when it has been awake for half a lease, in which it lets all its neighbours hear
from it, or they have noticed that it is gone and have linked up again. And neighbours go on telling a robot that is
stopped their states, until its link has ended: after a few ticks the world waits for that, for a socket that is full
would stop them, too, and for good. Nothing of this changes the truth.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from protocol.messages import Inject
from protocol.scenario import Scenario, lease_ms
from world_server.session import KILL, STOP, WorldSession

Publish = Callable[[Inject], None]
FEW = 16  # states that any socket has room for
LINKS_END = 5.0  # leases after which all links of a process that was really stopped have ended


class Returns:
    """The awaited robots of a run."""

    def __init__(self, scenario: Scenario, inject: Publish | None) -> None:
        """`inject` reaches the launcher; None: there is none, and nobody is really stopped."""
        self._lease = 1e-3 * lease_ms(scenario.network, scenario.robots, scenario.clock)
        self._patience = scenario.network.return_timeout
        self._publish = inject
        self._stopped: dict[int, tuple[float, int]] = {}  # robot -> when it was stopped, s of the wall clock, and the tick
        self._called: dict[int, float] = {}
        self._awake: dict[int, float] = {}

    def inject(self, order: Inject) -> None:
        """Pass on what is to be done to a process."""
        if self._publish is not None:
            self._publish(order)
            if order.action == STOP:
                self._stopped.setdefault(order.robot, (time.monotonic(), order.tick))
            elif order.action == KILL:
                self._stopped.pop(order.robot, None)

    def stopped(self, robot: int, tick: int) -> None:
        """A robot's process was found to stand still, unplanned."""
        self._stopped.setdefault(robot, (time.monotonic(), tick))

    def hold(self, session: WorldSession) -> bool:
        """Whether the world is not to step yet, for the links of a robot that is stopped have not ended."""
        if not self._stopped:
            return False
        now, tick = time.monotonic(), session.world.tick
        return any(
            tick - since >= FEW and now - when < LINKS_END * self._lease and session.is_linked(i)
            for i, (when, since) in self._stopped.items()
        )

    def look(self, session: WorldSession) -> None:
        """Let in who is there, and give up who does not come; to be called some ten times a second."""
        now = time.monotonic()
        for i in sorted(session.awaited):
            called = self._called.setdefault(i, now)
            if i in session.answered:
                self._awake.setdefault(i, now)
            else:
                self._awake.pop(i, None)
            silent = called - self._stopped.get(i, (called, 0))[0]
            rest = 0.5 * self._lease if silent > 0.5 * self._lease else 0.0
            if i in session.returned and now - self._awake[i] >= rest:
                self._forget(i)
                session.admit(i)
            elif now - called > self._patience:
                self._forget(i)
                session.give_up(i)

    def _forget(self, robot: int) -> None:
        self._stopped.pop(robot, None)
        self._called.pop(robot, None)
        self._awake.pop(robot, None)
