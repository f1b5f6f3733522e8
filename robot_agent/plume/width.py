"""How wide the way of the air is, and how probable a hit at its end makes a source beside it.

The way's variance grows with the lag as was measured in such winds (docs/plume-map.md), with D = D_min + k_D 5 s var(wind):
    sigma(q)^2 = sigma_0^2 + D_min q + (D - D_min) 20 q / (1 + (28 s / q)^3).
For some seconds next to nothing, for the robot met the same wind as the plume beside it; later far more than D says.
"""

from __future__ import annotations

from itertools import pairwise
from math import erf, hypot, sqrt

from protocol.scenario.laws import PlumeMap
from robot_agent.plume.events import LAGS, Event

SHARED = 28.0  # s: for so long the air that a robot meets now and its own samples have nearly shared the same wind
APART = 20.0  # much further back they have not, and the way's variance grows so many times faster than D says
EDGE = 0.03  # m: the least deviation of the way alone
# By which the part of D that comes of the wind's variance makes the way's variance grow up to every lag.
_GROWTH = (0.0, *(APART * lag / (1.0 + (SHARED / lag) ** 3) for lag in LAGS))


def variances(event: Event, p: PlumeMap) -> list[float]:
    """sigma^2 at the beginning of the way and at every lag, m^2."""
    least, more = min(event.D, p.spread), max(0.0, event.D - p.spread)
    return [p.blur**2 + least * q + more * by for (q, _, _), by in zip(event.way, _GROWTH, strict=True)]


def smelt(offset: float, variance: float, p: PlumeMap) -> float:
    """P: the probability to smell a source that the way passes at `offset` m, where its sigma^2 is `variance`."""
    s = sqrt(2.0 * max(variance - p.reach**2 / 3.0, EDGE**2))
    return 0.5 * p.detect * (erf((p.reach - offset) / s) + erf((p.reach + offset) / s))


def explains(event: Event, x: float, y: float, p: PlumeMap, within: float = LAGS[-1]) -> float:
    """P of the event for a source at (x, y) m: where the way passes it best; it is smelt a little upwind, too.

    Args:
        within: s: only as far back.
    """
    spread = variances(event, p)
    best = 0.0
    for m, ((q, x1, y1), (_, x2, y2)) in enumerate(pairwise(event.way)):
        if q >= within:
            break
        dx, dy = x2 - x1, y2 - y1
        length = hypot(dx, dy)
        if length > 0.0:
            part = ((x - x1) * dx + (y - y1) * dy) / length**2
            part = min(max(part, 0.0 if m else -p.upwind / length), 1.0)
            variance = spread[m] + max(part, 0.0) * (spread[m + 1] - spread[m])
            best = max(best, smelt(hypot(x1 + part * dx - x, y1 + part * dy - y), variance, p))
    return best
