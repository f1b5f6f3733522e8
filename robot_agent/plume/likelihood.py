"""What an event says about a source beside the way of the air, as whole numbers.

The plume is smelt within r of its middle line, and where that runs is uncertain by s. A source that the way passes at the
lateral distance d, lag q before the event, is smelt with the probability
    P = p_m (Phi((r - d) / s) - Phi((-r - d) / s)),    s^2 = sigma^2 - r^2 / 3
(sigma(q), see `robot_agent.plume.width`, is the deviation of both together: r^2 / 3 is the variance of a place somewhere
within r). By Bayes' rule the event adds to the logarithm of the likelihood
    hit:   b_d log(1 + (1 - p_fa) P / p_fa)
    miss:  b_n log(1 - P) / (1 + q / tau_c)
(misses in a row share the same error of the way: far ones say little new).

Rules: rows of whole numbers over z = d / sigma for a ladder of sigmas. Sums of whole numbers are the same in any order: that
is what makes maps equal to the bit.
"""

from __future__ import annotations

from functools import lru_cache
from math import log

from protocol.scenario.laws import PlumeMap
from robot_agent.plume.width import smelt

ONE = 1 << 12  # a nat
STEPS = 12  # entries per unit of z
REACH = 2.75  # sigmas
WIDTH = int(REACH * STEPS)
LADDER = 1.06  # ratio of neighbouring sigmas
RUNGS = 60  # the widest is sigma_0 1.06^59 = 31 sigma_0
LEVELS = 8
SHARP = 16  # rungs: 1.06^16 = 2.5 sigma_0

Row = tuple[int, ...]


class Likelihood:
    """The tables of a scenario."""

    def __init__(self, p: PlumeMap) -> None:
        self._blur2 = p.blur**2
        self._log_ladder = 2.0 * log(LADDER)
        self.tau = p.tau
        sigmas = [p.blur * LADDER**n for n in range(RUNGS)]
        self.hits = [self._row(sigma, p, True) for sigma in sigmas]
        self.misses = [self._row(sigma, p, False) for sigma in sigmas]
        # Where the way begins: P times (level + 1/2) / LEVELS. There the way is still sharp.
        self.begin_hits, self.begin_misses = (
            [[self._row(sigma, p, hit, (level + 0.5) / LEVELS) for sigma in sigmas[:SHARP]] for level in range(LEVELS)]
            for hit in (True, False)
        )
        self.sigmas = sigmas
        # Looked up rather than computed: a logarithm for every line of cells would cost more than the cells.
        self.fine = 16.0 / self._blur2
        self.rungs = [self._exact((n + 0.5) / self.fine) for n in range(16 * 64)]

    def rung(self, variance: float) -> int:
        """Place in the ladder of sqrt(variance)."""
        n = int(variance * self.fine)
        return self.rungs[n] if n < len(self.rungs) else self._exact(variance)

    def _exact(self, variance: float) -> int:
        n = int(log(variance / self._blur2) / self._log_ladder + 0.5)
        return min(max(n, 0), RUNGS - 1)

    @staticmethod
    def _row(sigma: float, p: PlumeMap, hit: bool, share: float = 1.0) -> Row:
        """Entries for z = -REACH ... REACH; entry n is for (n - WIDTH) / STEPS <= z < (n + 1 - WIDTH) / STEPS.

        One more at the end is for a z that rounding has carried there.
        """
        row = []
        for n in range(2 * WIDTH + 1):
            z = (n + 0.5 - WIDTH) / STEPS
            P = share * smelt(z * sigma, sigma**2, p)
            gain = p.hit * log(1.0 + (1.0 - p.false) * P / p.false) if hit else p.miss * log(1.0 - P)
            row.append(round(ONE * gain))
        return tuple(row)


@lru_cache(maxsize=8)
def likelihood(p: PlumeMap) -> Likelihood:
    """The tables of `p`; robots in one process, and runs in one sweep, share them."""
    return Likelihood(p)
