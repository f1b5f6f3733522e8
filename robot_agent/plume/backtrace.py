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
CORRELATED = 5.0  # s: how long the wind's deviations last, 1 / wind.bandwidth


class WindPast:
    """Own wind samples, one per decision."""

    def __init__(self, p: PlumeMap, step: float) -> None:
        """`step`: time between two samples, s."""
        self._p = p
        self._step = step
        self._samples: deque[Place] = deque(maxlen=max(2, round(p.wind_memory / step)))

    def record(self, wind: Place) -> None:
        self._samples.append(wind)

    def prefill(self, winds: Iterable[Place]) -> None:
        self._samples.extend(winds)

    def way(self) -> list[Place]:
        """Displacement of the air during the latest LAGS[m] seconds, m."""
        samples, step = self._samples, self._step
        mean = (0.0, 0.0)
        if len(samples) < round(LAGS[-1] / step):
            n = max(len(samples), 1)
            mean = (sum(u for u, _ in samples) / n, sum(v for _, v in samples) / n)
        x = y = 0.0
        n = 0
        places = []
        latest = reversed(samples)
        for lag in LAGS:
            for _ in range(round(lag / step) - n):
                u, v = next(latest, mean)
                x, y = x + u * step, y + v * step
            n = round(lag / step)
            places.append((x, y))
        return places

    def diffusivity(self) -> float:
        """D = D_min + k_D 5 s var(w), m^2/s."""
        recent = list(self._samples)[-RECENT:] or [(0.0, 0.0)]
        variance = 0.0
        for component in zip(*recent, strict=True):
            mean = sum(component) / len(component)
            variance += sum([(w - mean) ** 2 for w in component]) / len(component)
        return self._p.spread + self._p.meander * CORRELATED * variance
