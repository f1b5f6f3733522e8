"""The worked examples of section 5.2: Figures 5.4 (5.1), 5.5 and 5.6 (5.4), and 5.7 (5.6), as double integrators.

Rules: gains, initial states and references as printed; where none is printed the row says what was taken. Not run again:
Figures 5.1 and 5.2 are diagrams that classify controllers, 5.3 and 5.18 are the graphs fig-5.3 and fig-5.18.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import pi
from typing import TYPE_CHECKING

from deploy.reproduce.chapter5.decay import below, furthest_pair, rate, seconds
from deploy.reproduce.chapter5.integrators import LINE_DEGREE, Sampling, integrate
from deploy.reproduce.kinds import AGREES, DIFFERS, OURS, Options, Reproduction, Result, Row
from robot_agent.control.consensus_laws import agreement, circular, formation, orbit, parallel
from robot_agent.sig import explicit_step

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

BETA, GAMMA, ALPHA, LAM = 0.5, 0.9, 0.6, 0.1
DT = 5e-4  # s
MU = (1.0, 3.0)  # the nonzero eigenvalues of Figure 5.3
K = 2.0 * LINE_DEGREE * GAMMA  # of (5.1), 1/s; the terms of lambda come on top
V_C = (9.0, -9.0)
CENTRE, RADIUS, TURN = (20.0, 20.0), 10.0, 2.5
PLACES = ((41.7194, -21.4161), (25.72, 25.3729), (-11.9554, 6.7822))
SPEEDS = ((-8.4829, -8.9210), (0.6160, 5.5833), (8.6802, -7.4019))
HERE = (0.0, 0.0)  # a reference as seen from itself
PAIRS = ((0, 1), (0, 2), (1, 2))
EXPONENTIAL = "on phi = 0 the error obeys (gamma mu + lambda) y' = -beta mu y: exponential, without an end"


def _rows(what: str, t: Array, error: Array, bounds: Sequence[float]) -> list[Row]:
    times = ", ".join(f"{bound:g}: {seconds(below(t, error, bound))}" for bound in bounds)
    return [Row(f"{what} stays below", "", times, OURS)]


def consensus_example(options: Options) -> Result:
    """Figure 5.4, seen from the middle of the group: (5.1) knows differences only."""
    import numpy as np

    from deploy.reproduce.chapter5.pictures import decays
    from protocol.topology.analysis import analyse, gain_condition
    from protocol.topology.named import build

    phi = partial(agreement, beta=BETA, gamma=GAMMA)
    xs, vs = [(x, 0.0) for x in (-9.0, 0.0, 9.0)], [(v, 0.0) for v in (20.0, 4.0, -20.0)]
    course = integrate(phi, xs, vs, 60.0, Sampling(ALPHA, K, DT, centred=True))
    explicit = integrate(phi, xs, vs, 60.0, Sampling(ALPHA, K, 0.01, explicit_step, centred=True))
    t, x, v = course.t, furthest_pair(course.x), furthest_pair(course.v)
    slope, floor, at = rate(t, x, 20.0, 50.0), float(furthest_pair(explicit.v)[-1]), int(np.argmin(np.abs(t - 55.32)))
    bound = gain_condition(analyse(build("fig-5.3", 3)), BETA, GAMMA)
    result = Result(numbers={"rate": slope, "explicit_floor": floor, "error_at_55.32": float(x[at])})
    result.rows = [
        Row("condition (5.2)", "gamma = 0.9 fits", f"gamma > {bound.bound:.4f}", AGREES if bound.holds else DIFFERS),
        Row("the system is stable", "at T > 55.32 (Remark 22)", f"largest |x_i - x_j| at 55.32 s: {x[at]:.1e} m", AGREES,
            "no event: about where a falling exponential crosses 1e-12"),
        Row("rate of the tail of |x_i - x_j|", "a finite time (Proposition 8)",
            f"{slope:.4f} /s; beta/gamma = {BETA / GAMMA:.4f} /s", DIFFERS, EXPONENTIAL),
        *_rows("largest |x_i - x_j|, m,", t, x, (1e-3, 1e-6, 1e-9, 1e-12)),
        *_rows("largest |v_i - v_j|, m/s,", t, v, (1e-3, 1e-6, 1e-9, 1e-12)),
        Row("|v_i - v_j| under an explicit step of 0.01 s", "", f"stays at {floor:.1e} m/s", OURS,
            "chatter; the robots take the implicit step, which has none"),
    ]  # fmt: skip
    panels = {
        label: {f"|{q}{i + 1} - {q}{j + 1}|": np.abs(values[:, i, 0] - values[:, j, 0]) for i, j in PAIRS}
        for label, q, values in (("velocities, m/s", "v", course.v), ("positions, m", "x", course.x))
    }
    result.figures[""] = decays(t, panels, 55.32, (BETA / GAMMA, "exp(-t beta/gamma)"))
    return result


def parallel_example(options: Options) -> Result:
    """Figures 5.5 and 5.6, seen from the places h_i + v_c t."""
    import numpy as np

    from deploy.reproduce.chapter5.pictures import decays, ways_figure

    h, v_c = np.array(formation(10.0, 3, 3)), np.array(V_C)
    phi = partial(parallel, v_c=HERE, beta=BETA, gamma=GAMMA, lam=LAM)
    course = integrate(phi, (PLACES - h).tolist(), (SPEEDS - v_c).tolist(), 60.0, Sampling(ALPHA, K + LAM, DT))
    t, x = course.t, course.x
    apart, drift = furthest_pair(x), np.linalg.norm(course.v, axis=2)
    fastest = drift.max(axis=1)
    at = int(np.argmin(np.abs(t - 46.05)))
    modes = {MU[0]: x[:, 0] - x[:, 2], MU[1]: x[:, 0] - 2.0 * x[:, 1] + x[:, 2]}  # eigenvectors of Figure 5.3
    rates = {mu: rate(t, np.linalg.norm(y, axis=1), 30.0, 45.0) for mu, y in modes.items()}
    theory = {mu: BETA * mu / (GAMMA * mu + LAM) for mu in MU}
    result = Result(numbers={"rates": rates, "theory": theory, "error_at_46.05": float(apart[at])})
    result.rows = [
        Row("settling time", "T = 46.05", f"at 46.05 s the formation is {apart[at]:.1e} m and the velocities are"
            f" {fastest[at]:.1e} m/s off", AGREES, "no event: about where an exponential crosses 1e-9"),
        *(Row(f"rate of the tail, eigenvalue {mu:g} of L", "a finite time (Corollary 2)",
              f"{rates[mu]:.4f} /s; beta mu / (gamma mu + lambda) = {theory[mu]:.4f} /s", DIFFERS, EXPONENTIAL)
          for mu in MU),
        *_rows("largest |v_i - v_c|, m/s,", t, fastest, (1e-3, 1e-6, 1e-9)),
        *_rows("formation error, m,", t, apart, (1e-3, 1e-6, 1e-9)),
    ]  # fmt: skip
    shown = t <= 10.0
    joined = [int(np.argmin(np.abs(t - s))) for s in (0.0, 2.0, 4.0, 6.0, 8.0, 10.0)]
    ways = x[shown] + h + v_c * t[shown, None, None]
    result.figures[""] = ways_figure(ways, joined, "Figure 5.5: parallel movement, the first 10 s")
    panels = {
        "velocities, m/s": {f"|v{i + 1} - v_c|": drift[:, i] for i in range(3)},
        "formation, m": {f"robots {i + 1}, {j + 1}": np.linalg.norm(x[:, i] - x[:, j], axis=1) for i, j in PAIRS},
    }
    result.figures["5.6"] = decays(t, panels, 46.05, (theory[1.0], f"exp(-{theory[1.0]:.2f} t)"))
    return result


def circular_example(options: Options) -> Result:
    """Figure 5.7, seen from the places h_i(t) on the circle; theta_i = 2 pi i / 3 + omega_0 t."""
    import numpy as np

    from deploy.reproduce.chapter5.pictures import decays, ways_figure

    def circle(s: float) -> Array:
        """Places and their velocities, (N, 2, 2)."""
        orbits = [orbit(RADIUS, TURN, 2 * pi * (i + 1) / 3 + TURN * s) for i in range(3)]
        places: Array = np.array(orbits) + np.array([CENTRE, HERE])
        return places

    phi = partial(circular, centre=HERE, beta=BETA, gamma=GAMMA, lam1=LAM, lam2=LAM)
    start = circle(0.0)
    course = integrate(phi, (PLACES - start[:, 0]).tolist(), (-start[:, 1]).tolist(), 80.0, Sampling(ALPHA, K + LAM, DT))
    t, x = course.t, course.x
    off = np.linalg.norm(x, axis=2).max(axis=1)
    ways = x + np.array([circle(s)[:, 0] for s in t])
    modes = {0.0: x.sum(axis=1), MU[0]: x[:, 0] - x[:, 2], MU[1]: x[:, 0] - 2.0 * x[:, 1] + x[:, 2]}
    rates = {mu: rate(t, np.linalg.norm(y, axis=1), 45.0, 55.0) for mu, y in modes.items()}
    theory = {mu: (BETA * mu + LAM) / (GAMMA * mu + LAM) for mu in modes}
    radii = np.linalg.norm(ways[t > t[-1] - 2 * pi / TURN] - CENTRE, axis=2)
    result = Result(numbers={"rates": rates, "theory": theory, "radius": [float(radii.min()), float(radii.max())]})
    result.rows = [
        Row("initial state", "not printed", "the places of the example of (5.4), at rest", OURS),
        Row("radius in the last turn", "r = 10", f"{radii.min():.6f} to {radii.max():.6f} m", AGREES
            if np.abs(radii - RADIUS).max() < 1e-3 else DIFFERS,
            "at 25 m/s: the example has no bodies; the robots do 0.8 m/s"),
        *(Row(f"rate of the tail, eigenvalue {mu:g} of L", "a finite time (Corollary 3)",
              f"{rates[mu]:.4f} /s; (beta mu + lambda_2) / (gamma mu + lambda_1) = {theory[mu]:.4f} /s", DIFFERS,
              "on phi = 0 the error obeys (gamma mu + lambda_1) y' = -(beta mu + lambda_2) y; the step adds about"
              f" {DT * (K + LAM) * theory[mu] / (GAMMA * mu + LAM):.1%}") for mu in modes),
        *_rows("largest |x_i - h_i - h^c|, m,", t, off, (1.0, 1e-3, 1e-6)),
    ]  # fmt: skip
    shown = t <= 30.0
    result.figures[""] = ways_figure(ways[shown], (), "Figure 5.7: circular movement, the first 30 s")
    curves = {f"eigenvalue {mu:g} of L": np.linalg.norm(y, axis=1) for mu, y in modes.items()}
    result.figures["error"] = decays(t, {"modes of x_i - h_i - h^c, m": curves}, None, (theory[0.0], "exp(-t)"))
    return result


WORKED = (
    Reproduction("fig-5.4", "consensus (5.1) of three double integrators", "section 5.2.2, Figure 5.4, Remark 22",
                 consensus_example),
    Reproduction("fig-5.5", "parallel motion (5.4) of three double integrators", "section 5.2.3, Figures 5.5, 5.6",
                 parallel_example),
    Reproduction("fig-5.7", "circular motion (5.6) of three double integrators", "section 5.2.4, Figure 5.7",
                 circular_example),
)  # fmt: skip
