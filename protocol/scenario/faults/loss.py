"""States that are lost on the way."""

from __future__ import annotations

from protocol.scenario.faults.base import OnEdges
from protocol.scenario.table import Fraction


class Loss(OnEdges, frozen=True, kw_only=True, tag="loss"):
    """Each state is lost with probability `probability`, on each edge by itself."""

    probability: Fraction

    def about(self) -> str:
        return f"{100 * self.probability:g} % of the states are lost {self.where}{self.till}"
