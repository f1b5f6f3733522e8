"""How long robots were away: from when they were lost until the world used a drive of theirs again.

Rules: pure; the wall clock's time is an argument.
"""

from __future__ import annotations

from collections.abc import Container


class Absences:
    """The robots that were lost and may come back."""

    __slots__ = ("_since",)

    def __init__(self) -> None:
        self._since: dict[int, tuple[float, float]] = {}

    def lost(self, robot: int, now: float, t: float) -> None:
        """`robot` was lost at `now` on the wall clock, at simulated time `t`, s."""
        self._since.setdefault(robot, (now, t))

    def stepped(self, drove: Container[int], now: float, t: float) -> list[tuple[int, str]]:
        """The world has stepped to `t` with drives of the robots `drove`: who of them is back, and how long it took."""
        if not self._since:
            return []
        back = [i for i in sorted(self._since) if i in drove]
        said = []
        for i in back:
            lost_at, lost_t = self._since.pop(i)
            away = f"{now - lost_at:.2f} s after it was lost ({t - lost_t:.2f} s simulated)"
            said.append((i, f"robot {i} drives again, {away}"))
        return said
