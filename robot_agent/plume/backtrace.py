"""The way of the air: one robot's wind samples, and where the air that it meets now was before.

Rules: own samples only, so that nobody's map hangs on whose samples have arrived. Seconds further back than the memory
goes (a cold start, a robot that came late) are taken to have had the mean wind of those that are known, and the
uncertainty of the way grows faster there.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from protocol.scenario.laws import PlumeMap
from robot_agent.plume.events import LAGS, Place

RECENT = 60  # samples for the variance
FASTEST = 100.0  # m/s: what a broken sensor reads beyond this is cut, or it would stay in the sums for ever
CORRELATED = 5.0  # s: how long the wind's deviations last, 1 / wind.bandwidth


class WindPast:
    """Own wind samples, one per decision."""

    def __init__(self, p: PlumeMap, step: float) -> None:
        """`step`: time between two samples, s."""
        self._p = p
        self._step = step
        # Sums of u, v and u^2 + v^2 up to each sample, and before the first: any stretch of time is a difference of two.
        self._sums: deque[tuple[float, float, float]] = deque([(0.0, 0.0, 0.0)], max(2, round(p.wind_memory / step)) + 1)

    def record(self, wind: Place) -> None:
        u, v = (min(max(-FASTEST, w), FASTEST) for w in wind)  # this way about it is a number even if w is none
        x, y, square = self._sums[-1]
        self._sums.append((x + u, y + v, square + u * u + v * v))

    def prefill(self, winds: Iterable[Place]) -> None:
        for wind in winds:
            self.record(wind)

    def way(self) -> list[Place]:
        """Displacement of the air during the latest LAGS[m] seconds, m."""
        known = len(self._sums) - 1
        all_x, all_y, _ = self._latest(known)
        places = []
        for lag in LAGS:
            n = round(lag / self._step)
            if n <= known:
                x, y, _ = self._latest(n)
            else:
                scale = n / max(known, 1)
                x, y = all_x * scale, all_y * scale
            places.append((x * self._step, y * self._step))
        return places

    def diffusivity(self) -> float:
        """D = D_min + k_D 5 s var(w), m^2/s."""
        n = min(RECENT, len(self._sums) - 1)
        x, y, square = self._latest(n)
        n = max(n, 1)
        variance = max(0.0, square / n - (x * x + y * y) / (n * n))
        return self._p.spread + self._p.meander * CORRELATED * variance

    def _latest(self, n: int) -> tuple[float, float, float]:
        """Sums of the latest n samples."""
        (x, y, square), (from_x, from_y, from_square) = self._sums[-1], self._sums[-1 - n]
        return x - from_x, y - from_y, square - from_square
