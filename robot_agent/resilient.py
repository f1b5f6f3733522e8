"""The fusion (3.26) with neighbours that may lie: which of their values count.

Thesis (3.26):  phi_i = sum_j a_ij (y_j - y_i) + lambda_i (u_i - y_i); here the sum runs, for each axis,
    trimmed: over the neighbours that are left when of the values above y_i the F largest and of those below y_i the F
        smallest are taken away (all of them where there are fewer than F);
    median: over all, each with the median of y_i and the y_j in the place of y_j.
An honest y_i then never leaves the hull of the honest values and inputs, as long as at most F of its neighbours lie; and
the honest ones agree where the graph is (2F+1)-robust (`odourswarm topology` says how robust a graph is). The term in
beta, the input and the implicit step stay as they are: (3.26) is the same with F = 0.

What it costs: a value that one robot alone has is what a lie looks like, and is left out. In a plume that seldom two
robots measure at a time (`fusion.input` = "measured") the estimate then stays where it was until as many as F+1 do, and
with the median until a majority does (`fusion.judge` = "states"). Therefore robots judge each other's measurements as well,
as long as these are fresh (robot_agent.words, the default). To stay within the hull of the honest is not to be right,
either: within it a lie still moves the others.

Source: H. J. LeBlanc, H. Zhang, X. Koutsoukos, S. Sundaram, Resilient Asymptotic Consensus in Robust Networks, IEEE J.
Selected Areas in Communications 31(4), 2013 (W-MSR, discrete time, linear). The form with sig(.)^a and the median are
ours; the hull is kept for the same reason, as every step goes towards a mean of retained values.
"""

from __future__ import annotations

from collections.abc import Sequence

Valued = tuple[float, float]  # a_ij, y_j on one axis


def trimmed(y: float, values: Sequence[Valued], liars: int) -> list[Valued]:
    """`values` without the `liars` largest above y and the `liars` smallest below y."""
    below = sorted((v for v in values if v[1] < y), key=_value)
    above = sorted((v for v in values if v[1] > y), key=_value)
    return below[liars:] + above[: max(0, len(above) - liars)]


def centred(y: float, values: Sequence[Valued], liars: int) -> list[Valued]:
    """`values`, each weight at the median of all of them and y (of an even number the one of the middle two nearer y)."""
    if not values:
        return []
    ranked = sorted([y, *(value for _, value in values)])
    low, high = ranked[(len(ranked) - 1) // 2], ranked[len(ranked) // 2]
    middle = min(max(y, low), high)
    return [(a_ij, middle) for a_ij, _ in values]


def _value(valued: Valued) -> float:
    return valued[1]


FILTERS = {"trimmed": trimmed, "median": centred}
