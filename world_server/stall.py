"""When lock-step stands still: what was said is said again, and who never answers is done without.

A message can get lost with a link that comes and goes, when a process was stopped or the machine is busy; then everybody
waits, and nobody is dead. Whatever is said twice is known by its tick, so that saying it again changes nothing.

Rules: pure; the wall clock's time is an argument, and the truth does not depend on it as long as everybody answers.
"""

from __future__ import annotations

from world_server.session import WorldSession

AGAIN = 0.5  # s of the wall clock without any answer, after which everything is said again


class Stall:
    """Of one run.

    Args:
        patience: how long a robot may leave its answer out while all others wait for it, s. Counted in things said
            again: the time for which the machine itself was asleep is no robot's fault.
    """

    def __init__(self, patience: float) -> None:
        self._most = max(1, round(patience / AGAIN))
        self._seen: tuple[int, ...] = ()
        self._since = 0.0
        self._times = 0

    def look(self, session: WorldSession, now: float) -> bool:
        """To be called when nothing was heard; whether all who still take part have answered by what it did."""
        seen = (session.world.tick, len(session.unanswered), len(session.awaited), len(session.answered))
        if seen != self._seen:
            self._seen, self._since, self._times = seen, now, 0
            return False
        if now - self._since < AGAIN or (session.awaited and session.awaited.issubset(session.returned)):
            return False
        self._since = now
        self._times += 1
        if self._times == 1:
            session.tell("nobody says anything: what was said of this tick is said again")
        if self._times <= self._most or session.awaited:  # who is awaited is given up elsewhere (`world_server.returns`)
            session.ask_again()
            return False
        complete = False
        for robot in session.unanswered:
            complete = session.lose(robot, f"is done without: no answer for {self._most * AGAIN:g} s") or complete
        return complete
