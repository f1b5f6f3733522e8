"""How an error dies out: when it falls below a bound for good, and how fast its tail falls.

Rules: a tail that is a straight line on a logarithmic scale is exponential; one that ends in finite time bends down.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def below(t: Array, error: Array, bound: float) -> float | None:
    """First of the times `t` from which on `error` stays below `bound`; None when it is not below at the end."""
    above = [k for k, e in enumerate(error) if not e < bound]
    if not above:
        return float(t[0])
    return float(t[above[-1] + 1]) if above[-1] + 1 < len(t) else None


def rate(t: Array, error: Array, start: float, end: float) -> float:
    """Slope of -log(error) over t between the times `start` and `end`, 1/s."""
    import numpy as np

    chosen = (t >= start) & (t <= end) & (error > 0.0)
    return float(-np.polyfit(t[chosen], np.log(error[chosen]), 1)[0])


def furthest_pair(points: Array) -> Array:
    """Largest distance between two of the N points at each time, (K, N, 2) -> (K,)."""
    import numpy as np

    result: Array = np.linalg.norm(points[:, :, None] - points[:, None], axis=3).max(axis=(1, 2))
    return result


def furthest(points: Array, goals: Array | tuple[float, float]) -> Array:
    """Largest distance of the N points from their goals at each time, (K, N, 2) -> (K,)."""
    import numpy as np

    result: Array = np.linalg.norm(points - np.asarray(goals), axis=2).max(axis=1)
    return result


def seconds(t: float | None) -> str:
    """A time for a row."""
    return "not within the run" if t is None else f"{t:.1f} s"
