"""States that are overtaken by the next one."""

from __future__ import annotations

from protocol.scenario.faults.base import OnEdges
from protocol.scenario.table import Fraction


class Reorder(OnEdges, frozen=True, kw_only=True, tag="reorder"):
    """A state is held up for a tick and heard behind the newer one of that tick."""

    probability: Fraction

    def about(self) -> str:
        return f"{100 * self.probability:g} % of the states are overtaken by the next {self.where}{self.till}"
