"""The finite-time consensus fusion of the robots' estimates.

Thesis (3.26):  y_i' = phi_i + beta sig(phi_i)^a,  phi_i = sum_j a_ij (y_j - y_i) + lambda_i (u_i - y_i)

Departs from the thesis: lambda_i is 0 for a robot that did not measure at its last decision (switch `fusion.input`);
one implicit step per tick with the neighbours' states held (switch `fusion.step`). The linear part keeps the mean of
the y_i when lambda = 0; the term in beta does not, because it is a function of the sum over the neighbours. With
`fusion.kind` = "resilient" values that may be lies are left out of the sum (robot_agent.resilient), and u_i is the median of
what robots around say that they measured (robot_agent.words).
"""

from __future__ import annotations

from collections.abc import Iterable

from protocol.scenario.sections import Fusion
from robot_agent.resilient import FILTERS
from robot_agent.sig import STEPS

Point = tuple[float, float]


def step(
    y: Point,
    neighbours: Iterable[tuple[float, float, float]],
    u: Point | None,
    fusion: Fusion,
    degree: float,
    dt: float,
) -> Point:
    """y_i one tick later.

    Args:
        y: own fusion state y_i, m.
        neighbours: (a_ij, y_j,x, y_j,y) of the neighbours that count now.
        u: measurement input u_i = x_hat_i, m; None: lambda_i = 0.
        degree: largest row sum of the graph; the same for all robots.
        dt: length of the tick, s.
    """
    phi_x, phi_y = _plain(y, neighbours) if fusion.kind == "plain" else _resilient(y, neighbours, fusion)
    lam = 0.0
    if u is not None:
        lam = fusion.lam
        phi_x += lam * (u[0] - y[0])
        phi_y += lam * (u[1] - y[1])
    solve = STEPS[fusion.step]
    dt_k = dt * (2.0 * degree + lam)
    return (
        y[0] + dt * solve(phi_x, 1.0, fusion.beta, fusion.a, dt_k),
        y[1] + dt * solve(phi_y, 1.0, fusion.beta, fusion.a, dt_k),
    )


def _plain(y: Point, neighbours: Iterable[tuple[float, float, float]]) -> Point:
    """sum_j a_ij (y_j - y_i), m."""
    phi_x = phi_y = 0.0
    for a_ij, y_jx, y_jy in neighbours:
        phi_x += a_ij * (y_jx - y[0])
        phi_y += a_ij * (y_jy - y[1])
    return phi_x, phi_y


def _resilient(y: Point, neighbours: Iterable[tuple[float, float, float]], fusion: Fusion) -> Point:
    """The same sum, on each axis for itself, over what the filter leaves."""
    heard, keep = list(neighbours), FILTERS[fusion.filter]
    left_x = keep(y[0], [(a_ij, y_jx) for a_ij, y_jx, _ in heard], fusion.liars)
    left_y = keep(y[1], [(a_ij, y_jy) for a_ij, _, y_jy in heard], fusion.liars)
    return sum(a_ij * (v - y[0]) for a_ij, v in left_x), sum(a_ij * (v - y[1]) for a_ij, v in left_y)
