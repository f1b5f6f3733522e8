"""The virtual robots of chapter 6: one step of the coordinating control.

Thesis (6.4):  x_hat_i' = v_hat_i - beta sig(dJ/dx_hat_i)^q,
               v_hat_i' = w' + gamma sig(phi_i)^q,   phi_i = sum_j a_ij (v_hat_j - v_hat_i) + lambda (w - v_hat_i)
with w = v_c^i. (6.1) is lambda = 0, w' = 0; (6.3) is w = v_c for all; (6.5) is w = h_r' with the virtual robot in J.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from robot_agent.sig import Step


class Virtual(NamedTuple):
    """Virtual position, m, and velocity, m/s, of one robot."""

    x: float
    y: float
    vx: float
    vy: float


class Gains(NamedTuple):
    """Of one step of the coordinating control."""

    gamma: float
    lam: float  # lambda
    beta: float
    q: float
    row_sum: float  # the largest row sum of the graph: bounds the implicit step, see robot_agent.sig
    stiffness: float  # of J in one robot's place, 1/m: bounds it too


def accelerate(
    me: Virtual,
    heard: Iterable[tuple[float, Virtual]],
    reference: tuple[float, float],
    reference_dot: tuple[float, float],
    gains: Gains,
    step: Step,
    dt: float,
) -> tuple[float, float]:
    """v_hat_i' of (6.4b), m/s^2; `heard` are pairs (a_ij, state of j)."""
    phi_x = gains.lam * (reference[0] - me.vx)
    phi_y = gains.lam * (reference[1] - me.vy)
    for a_ij, other in heard:
        phi_x += a_ij * (other.vx - me.vx)
        phi_y += a_ij * (other.vy - me.vy)
    dt_k = dt * (2.0 * gains.row_sum + gains.lam)
    return (
        reference_dot[0] + step(phi_x, 0.0, gains.gamma, gains.q, dt_k),
        reference_dot[1] + step(phi_y, 0.0, gains.gamma, gains.q, dt_k),
    )


def descend(slope: tuple[float, float], gains: Gains, step: Step, dt: float) -> tuple[float, float]:
    """-beta sig(dJ/dx_hat_i)^q of (6.4a), m/s."""
    dt_k = dt * gains.stiffness
    return -step(slope[0], 0.0, gains.beta, gains.q, dt_k), -step(slope[1], 0.0, gains.beta, gains.q, dt_k)
