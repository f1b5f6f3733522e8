"""sig(x)^a = sign(x)|x|^a and a sampled-data step of the laws that are built on it.

The laws (3.26), (3.34), (4.12), (5.5), (5.7) all have the form

    s' = g phi + b sig(phi)^a,      d phi / d t = -K s' + (what the others do)

whose slope at phi = 0 is infinite: an explicit step of any length overshoots there and chatters in a band of order
dt^(1/(1-a)). The implicit step solves for the phi at the end of the step,

    phi_1 + dt K (g phi_1 + b sig(phi_1)^a) = phi_0,      s' = g phi_1 + b sig(phi_1)^a,

which has one solution with the sign of phi_0 and no larger than it, for any dt and K >= 0, and becomes the printed law
as dt goes to 0. With K twice the row sum of the graph (Gershgorin's bound on its Laplacian) neighbours that all step at
once cannot overshoot each other.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

Step = Callable[[float, float, float, float, float], float]


def sig(x: float, a: float) -> float:
    """sign(x) |x|^a."""
    if x > 0.0:
        return float(x**a)
    return -float((-x) ** a) if x < 0.0 else 0.0


def explicit_step(phi: float, g: float, b: float, a: float, dt_k: float) -> float:
    """s' of the printed law: g phi + b sig(phi)^a."""
    return g * phi + b * sig(phi, a)


def implicit_step(phi: float, g: float, b: float, a: float, dt_k: float) -> float:
    """s' = g phi_1 + b sig(phi_1)^a with phi_1 + dt_k s' = phi.

    Args:
        phi: argument of the law at the start of the step.
        g: linear gain, >= 0.
        b: gain of the finite-time term, >= 0.
        a: exponent, 0 < a < 1.
        dt_k: dt K >= 0; 0 gives the printed law.
    """
    size = abs(phi)
    linear = 1.0 + dt_k * g
    power = dt_k * b
    if size == 0.0 or power == 0.0:
        return explicit_step(phi / linear, g, b, a, 0.0)
    if a == 0.5:
        w = 2.0 * size / (power + sqrt(power * power + 4.0 * linear * size))
        rate = g * w * w + b * w
    else:
        w = _solve(linear, power, a, size)
        rate = g * float(w ** (1.0 / a)) + b * w
    return rate if phi > 0.0 else -rate


def _solve(linear: float, power: float, a: float, size: float) -> float:
    """w = s^a for the root s of linear s + power s^a = size, by Newton's method from the right, where it is convex."""
    inverse = 1.0 / a
    w = float(min((size / linear) ** a, size / power))
    for _ in range(50):
        s = float(w**inverse)
        excess = linear * s + power * w - size
        if excess <= 1e-14 * size:
            break
        w -= excess / (linear * s * inverse / w + power)
    return w


STEPS: dict[str, Step] = {"implicit": implicit_step, "explicit": explicit_step}
