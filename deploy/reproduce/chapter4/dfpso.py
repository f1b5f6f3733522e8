"""The discrete particle (4.21): PSO (gamma = 1, beta = 0, dk = 1), GPSO (4.5) (any dk), DFPSO (beta > 0).

Rules: explicit steps, as printed; p = 0, so that (4.23) is (4.21).

What the printed DFPSO does near its target can be calculated. sig(phi)^a = |phi|^(a-1) phi, so that (4.21) is the linear
system with the gain g = gamma + beta |phi|^(a-1) in gamma's place; that one is stable while g < g*, with

    g* = 4 / (dk (alpha dk + 2 (1 - omega)))                 (the second bound of (4.24), solved for gamma),

and g grows without bound as phi goes to 0. At |phi| = phi* = (beta / (g* - gamma))^(1/(1-a)) it is g* exactly: the
particle alternates between two places, |y_1| = dk^2 g* phi* / 4 from its target, for ever.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from deploy.reproduce.chapter4.fpso import START, Curve, Gains, State
from robot_agent.sig import explicit_step

Law = Callable[[float, float, float, float, float], float]


def particle(g: Gains, dk: float, steps: int, *, start: State = START, law: Law = explicit_step) -> Curve:
    """(4.21) from `start`; `law` is the printed step unless another of `robot_agent.sig.STEPS` is given."""
    y1, y2 = start
    dt_k = dk * (1.0 - g.omega + dk * g.alpha)
    path = [start]
    for _ in range(steps):
        y2 -= dk * law(g.phi(y1, y2), g.gamma, g.beta, g.a, dt_k)  # (4.21b)
        y1 += dk * y2  # (4.21a)
        path.append((y1, y2))
    return Curve(np.arange(steps + 1, dtype=np.float64) * dk, np.array(path).T)


def in_region(g: Gains, dk: float) -> bool:
    """Whether (omega, alpha, gamma) lie in Omega_d, (4.24): the linear part of (4.21) is stable."""
    pull = g.gamma * dk * (1.0 - g.omega)
    return 0.0 < pull < 2.0 and 0.0 < g.alpha < (4.0 - 2.0 * pull) / (g.gamma * dk * dk)


def critical_gain(g: Gains, dk: float) -> float:
    """g*: the largest gamma for which the linear part of (4.21) is stable by the bound on alpha in (4.24)."""
    return 4.0 / (dk * (g.alpha * dk + 2.0 * (1.0 - g.omega)))


def chatter(g: Gains, dk: float) -> tuple[float, float]:
    """(phi*, |y_1|) of the motion between two places that the printed DFPSO ends in; 0, 0 when beta = 0.

    Holds when: (omega, alpha, gamma) in Omega_d.
    """
    top = critical_gain(g, dk)
    phi = (g.beta / (top - g.gamma)) ** (1.0 / (1.0 - g.a)) if g.beta else 0.0
    return phi, 0.25 * dk * dk * top * phi
