"""States that arrive twice."""

from __future__ import annotations

from protocol.scenario.faults.base import OnEdges
from protocol.scenario.faults.delay import Late
from protocol.scenario.table import Fraction


class Duplicate(OnEdges, frozen=True, kw_only=True, tag="duplicate"):
    """A state arrives a second time, `after` later but at least one tick, behind the newer one of that tick."""

    probability: Fraction
    after: Late = 0.0  # s; at least one tick

    def about(self) -> str:
        return f"{100 * self.probability:g} % of the states arrive twice {self.where}{self.till}"
