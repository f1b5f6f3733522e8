"""Each robot's covariance stayed positive definite and finite.

Both axes of the Kalman filter (3.11)-(3.17) have the same variance, so the matrix is P times the identity: it is positive
definite when P > 0.
"""

from __future__ import annotations

from math import isfinite

from deploy.checkers.finding import Facts
from deploy.checkers.history import History


def covariance_positive(history: History) -> Facts:
    """A fact for every tick of every robot with a filter."""
    for life, act in history.acts():
        if life.fuses and act.mind is not None:
            P = act.mind.P
            wrong = f"robot {life.robot}'s covariance was {P:g} m² {history.when(act.tick)}; it must be > 0 and finite"
            yield None if isfinite(P) and P > 0.0 else wrong


def without_filter(history: History) -> str | None:
    """Why there is no covariance to look at."""
    if any(life.fuses for lives in history.lives.values() for life in lives):
        return None
    return f"{history.scenario.algorithm} has no Kalman filter and no fusion"
