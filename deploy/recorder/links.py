"""The communication graph as it is: which declared links carry, are silent, are broken, or are not declared now.

Rules: pure. A link is a pair of robots; it is up when both live and neither of them, as it last said, misses
the other; it is heard when, in every direction that is declared now, the listener used the other's state in
its last decision; it is closed when no direction is declared now, by the schedule or for want of range.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deploy.recorder.decisions import VALID
from protocol.messages import Belief
from protocol.scenario import Edge, Stage
from protocol.scenario.stage import stage_at

HEARD, SILENT, BROKEN, CLOSED = range(4)

Kinds = NDArray[np.int8]


class LinkWatch:
    """Follows the links of one run; times must not go back from call to call."""

    def __init__(
        self, graph: Sequence[Edge], n: int, period: float, stages: Sequence[Stage] = (), repeat: float = 0.0
    ) -> None:
        """`stages`, which begin anew after `repeat` s, say which edges of `graph` are declared when; none: always all."""
        declared = _matrix(graph, n)
        self._starts = [stage.at for stage in stages]
        self._repeat = repeat
        self._stages = [(_matrix(stage.edges, n), stage.range) for stage in stages]
        either = declared | declared.T
        self._declared = declared
        self._either = either
        self._a, self._b = (np.ascontiguousarray(ends) for ends in np.nonzero(np.triu(either)))
        self._linked = np.zeros((n, n), dtype=np.bool_)
        self._heard = np.zeros((n, n), dtype=np.bool_)
        self._spoke = np.full(n, -np.inf)
        self._speaks = np.zeros(n, dtype=np.bool_)  # alive, and has spoken lately
        self._valid = VALID * period + 1e-6
        self._waiting: list[Belief] = []

    @property
    def pairs(self) -> NDArray[np.intp]:
        """The declared links, (E, 2)."""
        return np.column_stack((self._a, self._b))

    @property
    def one_way(self) -> NDArray[np.intp]:
        """Links declared in one direction only, as (listener, speaker, place in `pairs`), (D, 3)."""
        one = self._declared[self._a, self._b] ^ self._declared[self._b, self._a]
        place = np.flatnonzero(one)
        a, b = self._a[place], self._b[place]
        forward = self._declared[a, b]
        return np.column_stack((np.where(forward, a, b), np.where(forward, b, a), place))

    @property
    def undeclared(self) -> NDArray[np.intp]:
        """Links that exist now though nobody declared them, (U, 2): there should be none."""
        linked = self._linked & self._speaks[:, None] & self._speaks
        return np.argwhere(np.triu((linked | linked.T) & ~self._either, k=1))

    def hear(self, beliefs: Sequence[Belief]) -> None:
        """Take what robots said; it counts from its own time on."""
        n = self._spoke.size
        self._waiting += [belief for belief in beliefs if 0 <= belief.robot < n]
        self._waiting.sort(key=lambda belief: belief.t)

    def at(self, t: float, alive: NDArray[np.bool_], points: NDArray[np.float64] | None = None) -> Kinds:
        """HEARD, SILENT, BROKEN or CLOSED for each of `pairs` at time `t` with the robots `alive`, (N,), at `points`,
        (N, 2); a range is measured between these."""
        self._listen(t)
        a, b, linked, heard, declared = self._a, self._b, self._linked, self._heard, self._declared_at(t, points)
        self._speaks = speaks = (t - self._spoke <= self._valid) & alive
        up = alive[a] & alive[b] & (linked[a, b] | ~speaks[a]) & (linked[b, a] | ~speaks[b])
        used = (speaks[a] & heard[a, b]) | ~declared[a, b]
        used &= (speaks[b] & heard[b, a]) | ~declared[b, a]
        kinds = np.where(up, np.where(used, HEARD, SILENT), BROKEN)
        return np.where(declared[a, b] | declared[b, a], kinds, CLOSED).astype(np.int8)

    def _declared_at(self, t: float, points: NDArray[np.float64] | None) -> NDArray[np.bool_]:
        if not self._stages:
            return self._declared
        declared, reach = self._stages[stage_at(self._starts, self._repeat, t)]
        if reach and points is not None:
            declared = declared & (np.linalg.norm(points[:, None] - points, axis=-1) <= reach)
        return declared

    def _listen(self, t: float) -> None:
        n = self._spoke.size
        count = 0
        for belief in self._waiting:
            if belief.t > t + 1e-6:
                break
            count += 1
            i = belief.robot
            if belief.t < self._spoke[i]:
                continue
            self._spoke[i] = belief.t
            for matrix, names in ((self._linked, belief.links), (self._heard, belief.heard)):
                matrix[i] = False
                matrix[i, [j for j in names if 0 <= j < n]] = True
        del self._waiting[:count]


def _matrix(graph: Sequence[Edge], n: int) -> NDArray[np.bool_]:
    declared = np.zeros((n, n), dtype=np.bool_)
    for i, j, _ in graph:
        declared[i, j] = i != j
    return declared
