"""Homogeneous feedback of a double integrator: zero in finite time, which (4.9)-(4.12) and (5.1)-(5.7) do not reach.

For an error e with e' = w and w' = -f(e, w) the law is

    f(e, w) = sat_s1(k1 sig(e)^a1) + sat_s2(k2 sig(w)^a2),     0 < a1 < 1,  a2 = 2 a1 / (1 + a1).

Why finite time. Unsaturated, the field is homogeneous of degree k = a1 - 1 < 0 with weights (2, 1 + a1): put
(L^2 e, L^(1+a1) w) for (e, w), and times shrink by L^(1-a1). The energy E = integral of sat_s1(k1 sig(.)^a1) + w^2 / 2
has E' = -w sat_s2(k2 sig(w)^a2) <= 0, zero only while w = 0, which lasts only at e = 0: the origin is globally
asymptotically stable (LaSalle), saturated or not. A homogeneous system is finite-time stable if and only if it is
asymptotically stable and of negative degree [Bhat & Bernstein 2005]; with saturation the state comes from any start, after
some time, into the set where E says that no term saturates any more, so that it is finite-time stable globally too. With
the printed laws one argument phi = beta e + gamma w carries both errors: once phi = 0, e' = -(beta / gamma) e is all that is
left, and that is exponential.

Sources: exponents and law, Bhat & Bernstein, "Continuous finite-time stabilization of the translational and rotational
double integrators", IEEE Trans. Automatic Control 43(5), 1998 (which also treats a saturated form); Hong, Huang & Xu,
"On an output feedback finite-time stabilization problem", IEEE Trans. Automatic Control 46(2), 2001; the theorem on
homogeneous systems, Bhat & Bernstein, "Geometric homogeneity with applications to finite-time stability", Mathematics of
Control, Signals and Systems 17, 2005; Haimo, "Finite time controllers", SIAM J. Control Optim. 24, 1986, came first.

Sampled time. The slope at 0 is infinite; held over a tick, the explicit law chatters in a band, by homogeneity of order
dt^(2/(1-a1)) in e and dt^((1+a1)/(1-a1)) in w. `pull` takes each of its two terms at the end
of the tick, as far as the term itself moves the error,

    f1 = k1 sig(e + dt w - 2 K dt^2 f1)^a1,      f2 = k2 sig(w - 2 K dt f2)^a2,

where K counts who pulls at once: 1 for a robot on its own, a bound on the Laplacian's largest eigenvalue for a graph,
and the 2 leaves room for the two terms, which do not know of each other. So f1 <= |e + dt w| / (2 K dt^2) and
f2 <= |w| / (2 K dt): close to zero the closed loop is linear with m = mu / K in (0, 1], and as a double integrator under
a held input its modes obey  z^2 - (2 - 5m/4) z + 1 - 3m/4 = 0, with both roots inside the unit circle. No chatter is
left: below the band errors go on shrinking by a constant factor per tick.
"""

from __future__ import annotations

from typing import NamedTuple

from robot_agent.sig import implicit_step


class Law(NamedTuple):
    """Gains, exponents and limits of f."""

    a1: float  # 0 < a1 < 1
    k1: float  # > 0, m^(1-a1) / s^2
    k2: float  # > 0, m^(1-a2) / s^(2-a2)
    s1: float = 1e9  # most of the position term, m/s^2
    s2: float = 1e9  # most of the velocity term, m/s^2

    @property
    def a2(self) -> float:
        """The exponent that makes the law homogeneous."""
        return second_exponent(self.a1)


def second_exponent(a1: float) -> float:
    """a2 = 2 a1 / (1 + a1)."""
    return 2.0 * a1 / (1.0 + a1)


def pull(law: Law, e: float, w: float, dt: float, K: float) -> float:
    """f(e, w), m/s^2, with the sign of the pull: add it to the acceleration of who is to move by (e, w).

    Args:
        e: where to minus where, m.
        w: how fast to minus how fast, m/s.
        dt: how long it is held, s; 0 gives the law of continuous time.
        K: how many pull at once, see above; 1 for a robot on its own.
    """
    room = 2.0 * K * dt
    return bounded(implicit_step(e + dt * w, 0.0, law.k1, law.a1, room * dt), law.s1) + damp(law, w, dt, K)


def damp(law: Law, w: float, dt: float, K: float) -> float:
    """The velocity term of f alone, m/s^2."""
    return bounded(implicit_step(w, 0.0, law.k2, second_exponent(law.a1), 2.0 * K * dt), law.s2)


def bounded(x: float, most: float) -> float:
    """sat: x, and no more than `most` either way."""
    return -most if x < -most else min(x, most)
