"""The finite-time consensus fusion of the robots' estimates.

Thesis (3.26):  y_i' = phi_i + beta sig(phi_i)^a,  phi_i = sum_j a_ij (y_j - y_i) + lambda_i (u_i - y_i)

Departs from the thesis: lambda_i is 0 for a robot that did not measure at its last decision (switch `fusion.input`);
one implicit step per tick with the neighbours' states held (switch `fusion.step`). The linear part keeps the mean of
the y_i when lambda = 0; the term in beta does not, because it is a function of the sum over the neighbours.
"""

from __future__ import annotations

from collections.abc import Iterable

from protocol.scenario.sections import Fusion
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
    phi_x = phi_y = 0.0
    for a_ij, y_jx, y_jy in neighbours:
        phi_x += a_ij * (y_jx - y[0])
        phi_y += a_ij * (y_jy - y[1])
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
