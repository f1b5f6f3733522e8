"""States that arrive late, all alike or each by an amount of its own (jitter)."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.scenario.faults.base import OnEdges
from protocol.scenario.table import Fraction

Late = Annotated[float, Meta(ge=0, le=60)]  # s; the check says how long a robot keeps a state


class Delay(OnEdges, frozen=True, kw_only=True, tag="delay"):
    """A state arrives `delay` plus U[0, `jitter`] late, to the nearest tick."""

    delay: Late = 0.0  # s
    jitter: Late = 0.0  # s
    probability: Fraction = 1.0  # of a state to be late at all

    def about(self) -> str:
        late = f"{self.delay:g} s" if not self.jitter else f"{self.delay:g} to {self.delay + self.jitter:g} s"
        share = "" if self.probability == 1.0 else f"{100 * self.probability:g} % of the "
        return f"{share}states arrive {late} late {self.where}{self.till}"
