"""Double integrators (1.7) under the laws of chapter 5, as the worked examples of section 5.2 have them: no bodies.

Rules: the laws are those of the robots (`robot_agent.control.consensus_laws`). What is integrated is the motion relative
to the reference (a moving place h_i, the line v_c t): its own acceleration, which the law adds, cancels exactly, and
errors of 1e-12 m are not lost in places of 100 m. u_i is held over a step, x_i and v_i are exact between the steps.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robot_agent.control.consensus_laws import Heard, Motion, Vector, respond
from robot_agent.sig import Step, implicit_step

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

# phi_i of a law, given the relative motions of robot i and of those that it hears.
Phi = Callable[[Motion, Heard], Vector]

LINE = ((1,), (0, 2), (1,))  # Figure 5.3: whom each robot hears, all weights 1
LINE_DEGREE = 2.0  # largest row sum


@dataclass(frozen=True, slots=True)
class Course:
    """How the robots moved, relative to their references."""

    t: NDArray[np.float64]  # (K,), s
    x: NDArray[np.float64]  # (K, N, 2), m
    v: NDArray[np.float64]  # (K, N, 2), m/s


@dataclass(frozen=True, slots=True)
class Sampling:
    """How u_i = phi_i + sig(phi_i)^alpha is sampled."""

    alpha: float
    K: float  # how fast phi answers to u at most, 1/s (robot_agent.sig)
    dt: float  # s
    step: Step = implicit_step
    keep: float = 0.05  # s between two samples that are kept
    centred: bool = False  # take the middle of the group off at every sample, for laws that know differences only


def integrate(phi: Phi, xs: Sequence[Vector], vs: Sequence[Vector], until: float, sampling: Sampling) -> Course:
    """The course on the graph of Figure 5.3 from (`xs`, `vs`), m and m/s, to the time `until`, s."""
    import numpy as np

    dt, dt_k, every = sampling.dt, sampling.dt * sampling.K, round(sampling.keep / sampling.dt)
    motions = [Motion(*x, *v) for x, v in zip(xs, vs, strict=True)]
    kept = []
    for k in range(round(until / dt) + 1):
        if k % every == 0:
            motions = _centred(motions) if sampling.centred else motions
            kept.append(motions)
        moved = []
        for m, hears in zip(motions, LINE, strict=True):
            u_x, u_y = respond(phi(m, [(1.0, motions[j]) for j in hears]), sampling.alpha, sampling.step, dt_k)
            x, y = m.x + dt * (m.vx + 0.5 * dt * u_x), m.y + dt * (m.vy + 0.5 * dt * u_y)
            moved.append(Motion(x, y, m.vx + dt * u_x, m.vy + dt * u_y))
        motions = moved
    table: NDArray[np.float64] = np.array(kept)
    t: NDArray[np.float64] = np.arange(len(kept), dtype=np.float64) * sampling.keep
    return Course(t, table[:, :, :2], table[:, :, 2:])


def _centred(motions: Sequence[Motion]) -> list[Motion]:
    middle = [sum(each) / len(motions) for each in zip(*motions, strict=True)]
    return [Motion(*(value - mean for value, mean in zip(m, middle, strict=True))) for m in motions]
