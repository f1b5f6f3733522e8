"""What speaks for a source at a place, beyond a narrow posterior: the odour was left there and met again.

Hits in a row share one error: a group that drifts along in one body of odour takes every second's hit for a new proof that
the source is near, and is sure soon. What such a place does not do is to give odour again, after a pause, the way it should.

A meeting is a hit before which nobody had smelt anything for `PAUSE` decisions. It counts for a place when a source there
explains it (`robot_agent.plume.width.explains`) and the odour came from there within `NEAR`: further off a plume is met
that begins elsewhere. A hit that a source there does not explain at all contradicts the place: what was before no longer
counts.

Rules: a function of the set of hits that are known, in whatever order they came.
"""

from __future__ import annotations

from protocol.scenario.laws import PlumeMap
from robot_agent.plume.events import Event
from robot_agent.plume.width import explains

PAUSE = 3  # decisions without a hit: the group had left the plume
MANY = 256  # decisions with hits that are remembered, more than `forget` lets count
NEAR = 5.0  # s
LIKELY = 0.3  # a source explains a hit from this P on. When a group is sure and right 99 of 100 hits have 0.33 and more,
ODD = 0.1  # and next to none has less than this


class Evidence:
    """The hits of late."""

    def __init__(self, p: PlumeMap) -> None:
        self._p = p
        self._hits: dict[int, list[Event]] = {}  # by decision

    def add(self, k: int, hit: Event) -> None:
        self._hits.setdefault(k, []).append(hit)
        if len(self._hits) > MANY:
            for old in sorted(self._hits)[: MANY // 2]:
                del self._hits[old]

    def meetings(self, since: float, x: float, y: float) -> int:
        """How often the odour was met again after decision `since`, near (x, y) m, as a source there explains it."""
        count = 0
        for k in sorted((k for k in self._hits if k > since), reverse=True):
            hits = self._hits[k]
            if min(explains(hit, x, y, self._p) for hit in hits) < ODD:
                break
            near = max(explains(hit, x, y, self._p, NEAR) for hit in hits)
            if near >= LIKELY and self._hits.keys().isdisjoint(range(k - PAUSE, k)):
                count += 1
        return count
