"""Whether the gains of a consensus law fit the graph that it runs on, as a sentence for a person.

Rules: condition (5.2) is about undirected, connected graphs and is sufficient, not necessary: what fails it may still
run. For a directed graph, whose eigenvalues need not be real, the exact condition of the law's linear part is checked.
"""

from __future__ import annotations

from math import ceil, floor, inf, log10, sqrt

from protocol.topology.analysis import Analysis, gain_condition


def least_gamma(analysis: Analysis, beta: float) -> float:
    """The gamma beyond which the linear part of (5.1), u_i = sum_j a_ij (beta (x_j - x_i) + gamma (v_j - v_i)), agrees.

    A mode with eigenvalue mu of L obeys s^2 + gamma mu s + beta mu = 0; both roots have negative real parts where
        Re mu > 0  and  gamma > |Im mu| / |mu| sqrt(beta / Re mu):
    for real mu > 0 always, for complex ones only with enough gamma.

    Args:
        beta: position gain, 1/s^2, > 0.
    Returns: 1/s; infinite when some mu has no positive real part (of a graph without a spanning tree, see `analyse`).
    """
    if not analysis.spanning_tree:
        return inf
    return max((abs(mu.imag) / abs(mu) * sqrt(beta / mu.real) for mu in analysis.nonzero), default=0.0)


def fit_warning(analysis: Analysis, beta: float, gamma: float, table: str) -> str | None:
    """What a person ought to know of the gains `table`.beta and `table`.gamma on this graph; None: (5.2) holds.

    Args:
        table: of the scenario, e.g. "dcs".
    """
    if analysis.robots == 1:
        return None
    if not analysis.connected:
        return "the graph is not connected: no consensus law can make all its robots agree."
    if analysis.directed:
        return _directed(analysis, beta, gamma, table)
    condition = gain_condition(analysis, beta, gamma)
    if condition.holds:
        return None
    mu = min(value.real for value in analysis.nonzero)
    return (
        f"condition (5.2) fails: with {table}.beta = {beta:g} the eigenvalue mu = {mu:.4g} of L asks for"
        f" {table}.gamma > {rounded_up(condition.bound)}, and it is {gamma:g}. (5.2) is sufficient, not necessary: the"
        " robots may agree all the same, with more swinging."
    )


def _directed(analysis: Analysis, beta: float, gamma: float, table: str) -> str:
    if not analysis.spanning_tree:
        return "the graph is directed and has no spanning tree: no consensus law can make all its robots agree."
    needed = least_gamma(analysis, beta)
    mu = max(analysis.nonzero, key=lambda value: abs(value.imag) / abs(value) / sqrt(value.real))
    verdict = "that holds." if gamma > needed else "that fails: without the terms of lambda, large disagreement grows."
    return (
        "the graph is directed and condition (5.2) is about undirected ones. Checked instead is the linear part of the"
        f" law: with {table}.beta = {beta:g} the eigenvalue mu = {mu.real:.4g} {'+' if mu.imag >= 0 else '-'}"
        f" {abs(mu.imag):.4g}i of L asks for {table}.gamma > {rounded_up(needed)}, and it is {gamma:g}; {verdict}"
    )


def rounded_up(bound: float) -> str:
    """Four digits, so rounded that a gain greater than what is printed is great enough."""
    digits = 3 - floor(log10(bound)) if bound > 0 else 0
    return f"{ceil(bound * 10**digits - 1e-9) / 10**digits:.4g}"
