"""When a process that has ended is started again.

Rules: pure; time is an argument. The first restart is at once, the second within `window` after `backoff` seconds, each
further one after twice the pause before it, at most `max_backoff`. A process that would need more than `max_restarts`
within `window` is given up, once and for all.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from protocol.scenario.supervision import Supervision


class Mode(Enum):
    """Which ends call for a restart."""

    NEVER = "never"
    ALWAYS = "always"
    CRASHED = "crashed"  # ended by a signal, or with a status other than 0


@dataclass(frozen=True, slots=True)
class Restart:
    """Start it again at `at`, for the `number`-th time in all."""

    at: float
    number: int


@dataclass(frozen=True, slots=True)
class GiveUp:
    """Start it no more; `why` continues "robot 3 "."""

    why: str


@dataclass(slots=True)
class Policy:
    """What is done about one process."""

    mode: Mode
    table: Supervision
    restarts: int = 0
    given_up: bool = False
    _recent: list[float] = field(default_factory=list)  # when it was started again, within the window

    def ended(self, now: float, status: int) -> Restart | GiveUp | None:
        """It ended with `status` (negative: the signal); None: leave it as it is.

        Args:
            now: s on any clock that does not go back; the same one for all calls.
        """
        if self.given_up or self.mode is Mode.NEVER or (self.mode is Mode.CRASHED and status == 0):
            return None
        table = self.table
        self._recent = [at for at in self._recent if at > now - table.window]
        recent = len(self._recent)
        if recent >= table.max_restarts:
            self.given_up = True
            return GiveUp(
                f"is given up: it {how(status)} and has been started again {_times(recent)} within {table.window:g} s,"
                f" which is all that supervision.max_restarts allows"
            )
        pause = 0.0 if recent == 0 else min(table.max_backoff, table.backoff * 2.0 ** min(recent - 1, 64))
        self._recent.append(now + pause)
        self.restarts += 1
        return Restart(now + pause, self.restarts)


def how(status: int) -> str:
    """The end of a process, in words that continue "robot 3 "."""
    return f"ended with signal {-status}" if status < 0 else f"ended with status {status}"


def _times(n: int) -> str:
    return "once" if n == 1 else f"{n} times"
