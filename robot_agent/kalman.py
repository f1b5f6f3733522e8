"""The Kalman filter with intermittent observations for a source that does not move.

Thesis section 3.3.2, (3.10)-(3.17). Both axes have the same covariance, so P, R and K are scalars per axis.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Estimate:
    """x_hat, m, and its variance P per axis, m^2."""

    x: float
    y: float
    P: float


def predict(prior: Estimate, q: float) -> Estimate:
    """Time update (3.11), (3.12): the source stays; `q` is process noise, m^2 (0 in the thesis)."""
    return Estimate(prior.x, prior.y, prior.P + q) if q else prior


def update(prior: Estimate, z: tuple[float, float] | None, R: float) -> Estimate:
    """Measurement update (3.13), (3.16), (3.17); `z` None means that none arrived, lambda_k = 0.

    Args:
        z: measurement, m.
        R: its variance per axis, m^2.
    """
    if z is None:
        return prior
    P = prior.P
    K = P / (P + R)  # (3.13)
    return Estimate(prior.x + K * (z[0] - prior.x), prior.y + K * (z[1] - prior.y), (1.0 - K) * P)


def model_noise(sigma2: float, k: float) -> float:
    """R(k) = 1/k sum_{l=0}^{k-1} (k-l) sigma^2 = sigma^2 (k+1)/2, below (3.9), k seconds into the mission.

    The increments are correlated, so the variance of the mean is nearer k sigma^2/3; the thesis's value is kept.
    """
    return sigma2 * (k + 1.0) / 2.0


def printed_noise(previous: float, k: float) -> float:
    """R(k) = 1/k sum_{l=0}^{k-1} (k-l) R(k-1), the recursion printed in Algorithm 1: it grows like a factorial."""
    return min(previous * (k + 1.0) / 2.0, 1e300)
