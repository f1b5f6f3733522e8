"""The matrix inequality (4.25) of Proposition 7 and the largest beta that it admits.

    [ I - Q    A Q       0       ]
    [ Q A^T   -Q         Q H^T   ]  < 0,   Q > 0,   varpi = max(delta, delta eps),  delta = beta^2 (dk^4 + dk^2)
    [ 0        H Q      -I/varpi ]

Rules: an answer is an answer when the eigenvalues of the matrix that the solver gave say so; a solver's status is not
enough. (4.25) is linear in (Q, 1/varpi): the largest varpi is one convex problem, not a bisection.

What (4.25) is. With P = Q^-1 it says V(k + dk) < V(k), V = eta^T P eta, for every f with f^T f <= varpi |H eta|^2; it is
the bounded-real lemma, and holds for some Q exactly where varpi < 1 / max |H (z I - A)^-1|^2 over |z| = 1
(`bounded_real`, without a solver). The derivation (4.32)-(4.36) is right but for a misprint (P_2 = I / varpi, not
1/omega I). Its premise (4.30) is not: |phi|^(2a) <= eps |phi|^2 holds only for |phi| >= eps^(-1/(2(1-a))) (`reach`), so
that no finite eps covers phi -> 0 and Proposition 7's convergence does not follow (nor does it happen: `dfpso.chatter`).
"""

from __future__ import annotations

import warnings
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from deploy.reproduce.chapter4.dfpso import in_region
from deploy.reproduce.chapter4.fpso import Gains
from protocol.errors import ScenarioError

Array = NDArray[np.float64]
SLACKS = (1e-6, 1e-5, 1e-4, 1e-3)  # relative: how far below the largest varpi (4.25) is shown to hold strictly


class Certificate(NamedTuple):
    """A solution of (4.25)."""

    Q: Array  # (2, 2)
    varpi: float
    largest: float  # eigenvalue of the matrix of (4.25): below 0
    smallest: float  # eigenvalue of Q: above 0

    @property
    def holds(self) -> bool:
        return self.largest < 0.0 < self.smallest


def system(g: Gains, dk: float) -> tuple[Array, Array]:
    """A and H of (4.25), each (2, 2)."""
    c = 1.0 - g.omega
    gamma, alpha = g.gamma, g.alpha
    A = np.array(
        [
            [1.0 - gamma * dk**2 * alpha, dk - gamma * dk**2 * c],
            [-gamma * dk * alpha, 1.0 - gamma * dk * c],
        ]
    )
    return A, np.array([[alpha, c], [0.0, 0.0]])


def inequality(g: Gains, dk: float, varpi: float, Q: Array) -> Array:
    """The matrix of (4.25), (6, 6)."""
    A, H = system(g, dk)
    one, nil = np.eye(2), np.zeros((2, 2))
    return np.block([[one - Q, A @ Q, nil], [Q @ A.T, -Q, Q @ H.T], [nil, H @ Q, -one / varpi]])


def certificate(g: Gains, dk: float, varpi: float, Q: Array) -> Certificate:
    """Q with the eigenvalues that decide whether it solves (4.25)."""
    top = float(np.linalg.eigvalsh(inequality(g, dk, varpi, Q)).max())
    return Certificate(Q, varpi, top, float(np.linalg.eigvalsh(Q).min()))


def spread(dk: float) -> float:
    """delta / beta^2 = dk^4 + dk^2 of (4.29)."""
    return dk**4 + dk**2


def reach(g: Gains, eps: float) -> float:
    """The smallest |phi| at which (4.30) holds with this eps."""
    return float(eps ** (-1.0 / (2.0 * (1.0 - g.a))))


def solve(g: Gains, dk: float, *, eps: float = 1.0) -> Certificate | None:
    """A Q that solves (4.25) for the beta of `g`, shown by its eigenvalues; None when none was found.

    Args:
        g: gains; beta > 0.
        dk: step, s.
        eps: of (4.30); 1 covers |phi| >= 1.
    Raises: ScenarioError when cvxpy is missing or beta is not above 0.
    """
    if g.beta <= 0.0:
        raise ScenarioError(f"beta is {g.beta:g}; (4.25) needs a beta > 0.")
    varpi = g.beta**2 * spread(dk) * max(1.0, eps)
    found = _margin(g, dk, varpi) if in_region(g, dk) else None
    return found if found is not None and found.holds else None


def largest_varpi(g: Gains, dk: float) -> Certificate | None:
    """The largest varpi for which (4.25) has a solution, and one just below it; None outside Omega_d, where it has none.

    Raises: ScenarioError when cvxpy is missing, or when the solver fails (next to the edge of Omega_d).
    """
    if not in_region(g, dk):
        return None
    cp = _cvxpy()
    unit = bounded_real(g, dk, points=201)  # of the right size; the answer does not depend on it
    Q = cp.Variable((2, 2), symmetric=True)
    s = cp.Variable()  # unit / varpi
    matrix = _scaled(cp, g, dk, Q, unit, s)
    if _optimum(cp, cp.Minimize(s), [matrix << 0]):
        # The infimum is not attained by a strict inequality: step back as little as lets it be shown there.
        for slack in SLACKS:
            found = _margin(g, dk, (1.0 - slack) * unit / float(s.value))
            if found is not None and found.holds:
                return found
    raise ScenarioError(
        f"omega {g.omega:g}, alpha {g.alpha:g}, gamma {g.gamma:g}, dk {dk:g} are too close to the edge of Omega_d (4.24) "
        "for the solver of (4.25); choose gains further inside."
    )


def largest_beta(omega: float, alpha: float, gamma: float, dk: float, *, eps: float = 1.0) -> float:
    """The largest beta for which (4.25) is feasible; 0 outside Omega_d, where it never is.

    Thesis section 4.3.2, Remark 15: "by using Matlab LMI toolbox to solve (4.25) we can get the parameter beta".

    Args:
        omega: inertia, < 1.
        alpha: attraction, > 0.
        gamma: 0 < gamma <= 1.
        dk: step, s, > 0.
        eps: of (4.30), > 0; with 1 the inequality speaks of |phi| >= 1 only, `reach` tells for others.
    Returns:
        beta, shown feasible by eigenvalues, as are all smaller ones; none above it by more than a relative 1e-5 is, next
        to the edge of Omega_d 1e-3.
    Raises: ScenarioError when cvxpy is missing, or when the solver fails (next to the edge of Omega_d).
    """
    g = Gains(omega, alpha, gamma)
    found = largest_varpi(g, dk)
    return float((found.varpi / (spread(dk) * max(1.0, eps))) ** 0.5) if found else 0.0


def bounded_real(g: Gains, dk: float, points: int = 2001) -> float:
    """The largest varpi of (4.25) by the bounded-real lemma: 1 / max |H (z I - A)^-1|^2 over |z| = 1. No solver.

    Args:
        points: angles of z in each of the grids, every one of which looks closer at the peak of the one before.
    Holds when: the linear part is stable (Omega_d).
    """
    A, H = system(g, dk)
    (A11, A12), (A21, A22) = A
    h1, h2 = H[0]
    low, high, peak = 0.0, np.pi, 0.0
    for _ in range(4):
        angles = np.linspace(low, high, points)
        z = np.exp(1j * angles)
        # The only row of H that is not 0, times the adjugate of z I - A, over its determinant.
        first, second = h1 * (z - A22) + h2 * A21, h1 * A12 + h2 * (z - A11)
        gains = np.hypot(abs(first), abs(second)) / abs((z - A11) * (z - A22) - A12 * A21)
        best = int(gains.argmax())
        peak = float(gains[best])
        low, high = angles[max(0, best - 2)], angles[min(points - 1, best + 2)]
    return 1.0 / peak**2


def _margin(g: Gains, dk: float, varpi: float) -> Certificate | None:
    """The Q that puts the matrix of (4.25), scaled, furthest below 0."""
    cp = _cvxpy()
    Q = cp.Variable((2, 2), symmetric=True)
    t = cp.Variable()
    matrix = _scaled(cp, g, dk, Q, varpi, 1.0)
    if not _optimum(cp, cp.Maximize(t), [matrix << -t * np.eye(6), t <= 1.0]):
        return None
    value: Array = 0.5 * (Q.value + Q.value.T)
    return certificate(g, dk, varpi, value)


def _scaled(cp: Any, g: Gains, dk: float, Q: Any, unit: float, s: Any) -> Any:
    """The matrix of (4.25) for the varpi `unit` / s, its last rows and columns times sqrt(`unit`).

    A congruence, which changes no sign of an eigenvalue, and brings the numbers near 1 for a solver.
    """
    A, H = system(g, dk)
    H = unit**0.5 * H
    one, nil = np.eye(2), np.zeros((2, 2))
    return cp.bmat([[one - Q, A @ Q, nil], [Q @ A.T, -Q, Q @ H.T], [nil, H @ Q, -s * one]])


def _optimum(cp: Any, aim: Any, constraints: list[Any]) -> bool:
    """Solve; whether there is a value, accurate or not: the eigenvalues decide."""
    problem = cp.Problem(aim, constraints)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # "solution may be inaccurate"
        try:
            problem.solve(solver="CLARABEL")
        except cp.error.SolverError:
            return False
    return problem.value is not None and bool(np.isfinite(problem.value))


def _cvxpy() -> Any:
    try:
        import cvxpy
    except ImportError:
        raise ScenarioError("(4.25) is solved with cvxpy, which is not installed: pip install 'odourswarm[lmi]'.") from None
    return cvxpy
