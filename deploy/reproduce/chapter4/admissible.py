"""Proposition 7: Omega_d (4.24), the matrix inequality (4.25), the largest beta, and what they say and do not say."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from deploy.reproduce.chapter4.dfpso import chatter, in_region, particle
from deploy.reproduce.chapter4.finite_time import robot_gains
from deploy.reproduce.chapter4.fpso import Gains
from deploy.reproduce.chapter4.lmi import bounded_real, largest_beta, reach, solve, spread, system
from deploy.reproduce.kinds import AGREES, DIFFERS, OURS, Options, Reproduction, Result, Row
from protocol.randomness import rng_for

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DK = 0.5  # s, of section 4.4
NAMED = {
    "unimodal (ω = -0.7, α = 8.5)": Gains(-0.7, 8.5, 0.5, 0.01),
    "multimodal (ω = -2.1, α = 8.5)": Gains(-2.1, 8.5, 0.5, 0.01),
    "Table 4.5 (ω = -0.5, α = 8)": robot_gains(),
}


def inequality(options: Options) -> Result:
    """Feasible for the thesis's gains; the largest beta; its premise (4.30); the region (4.24)."""
    rows: list[Row] = []
    numbers: dict[str, object] = {}
    for name, g in NAMED.items():
        found = solve(g, DK)
        beta = largest_beta(g.omega, g.alpha, g.gamma, DK)
        check = (bounded_real(g, DK) / spread(DK)) ** 0.5
        eps = (beta / g.beta) ** 2
        left = float(np.abs(particle(g, DK, 3000).y[0, -100:]).max())
        numbers[name] = {
            "feasible": found is not None,
            "Q": found.Q.tolist() if found else None,
            "eigenvalues": [found.largest, found.smallest] if found else None,
            "largest_beta": beta,
            "largest_beta_bounded_real": check,
            "largest_eps": eps,
            "reach_phi": reach(g, eps),
            "chatter_phi": chatter(g, DK)[0],
            "left_m": left,
        }
        rows += [
            Row(
                f"(4.25), {name}, β = {g.beta:g}, ε = 1",
                "β is got by solving it (Remark 15)",
                f"feasible, largest eigenvalue {found.largest:.1f}" if found else "no solution found",
                AGREES if found else DIFFERS,
            ),
            Row("  largest β", "", f"{beta:.4f} (without a solver {check:.4f})", OURS, "ε = 1: for |φ| ≥ 1 only"),
            Row(
                f"  converges with β = {g.beta:g}",
                "within a finite-time interval",
                f"|x| = {left:.1e} m for ever (calculated {chatter(g, DK)[1]:.1e})",
                DIFFERS,
                f"(4.25) can be had with ε up to {eps:.0f}, which speaks of |φ| ≥ {reach(g, eps):.3f}; "
                f"the chatter is at |φ| = {chatter(g, DK)[0]:.1e}",
            ),
        ]
    needed = [f"{10.0 ** (2 * k * (1 - 0.5)):.0e}" for k in (2, 4, 6)]
    wrong, points = region_against_roots(options.seed)
    rows += [
        Row(
            "an ε with |φ|^2a ≤ ε|φ|² for 0 < |φ| ≤ 1, a = 0.5 (4.30)",
            "there exists one",
            f"must be {', '.join(needed)} at |φ| = 1e-2, 1e-4, 1e-6",
            DIFFERS,
            "no finite ε: ε = |φ|^(2a-2) grows without bound as φ → 0",
        ),
        Row(
            "Ω_d (4.24) against the roots of (4.27)",
            "is the region of stability",
            f"{points - wrong} of {points} points drawn agree",
            AGREES if wrong == 0 else DIFFERS,
        ),
        Row(
            "P_2 below (4.36)",
            "I/ω",
            "I/ϖ",
            DIFFERS,
            "a misprint: (4.25) itself has ϖ. The other steps of (4.32)-(4.36) hold",
        ),
        Row(
            "“finite-time stable since it is a discrete-time version”",
            "end of the proof",
            "does not follow",
            DIFFERS,
            "nor is (4.9) finite-time: see prop-6",
        ),
    ]
    return Result(rows, {"": _map()}, numbers)


def region_against_roots(seed: int, points: int = 4000) -> tuple[int, int]:
    """Points of (omega, alpha, gamma, dk) drawn around Omega_d where (4.24) and the eigenvalues of A disagree."""
    draw = rng_for(seed, "reproduce", "omega_d").uniform
    wrong = 0
    for _ in range(points):
        gamma, dk = 0.05 + 0.95 * draw(), 0.1 + 0.9 * draw()
        # 0 at one edge of Omega_d and 1 at the other
        pull, share = -0.5 + 3.0 * draw(), -0.3 + 1.6 * draw()
        top = (4.0 - 2.0 * pull) / (gamma * dk * dk)
        g = Gains(1.0 - pull / (gamma * dk), share * top, gamma)
        stable = float(np.abs(np.linalg.eigvals(system(g, dk)[0])).max()) < 1.0
        wrong += stable != in_region(g, dk)
    return wrong, points


def _map() -> Figure:
    """The largest beta over Omega_d, gamma = dk = 0.5, by the bounded-real lemma."""
    from matplotlib.figure import Figure

    omegas, alphas = np.linspace(-6.96, 0.96, 100), np.linspace(0.16, 31.84, 100)
    largest = np.full((len(alphas), len(omegas)), np.nan)
    for j, omega in enumerate(omegas):
        for i, alpha in enumerate(alphas):
            g = Gains(float(omega), float(alpha), 0.5)
            if in_region(g, DK):
                largest[i, j] = (bounded_real(g, DK, points=100) / spread(DK)) ** 0.5
    figure = Figure(figsize=(8.0, 5.5), layout="constrained")
    axis = figure.subplots()
    mesh = axis.pcolormesh(omegas, alphas, largest, cmap="viridis", shading="nearest")
    figure.colorbar(mesh, label="largest β of (4.25), ε = 1")
    axis.plot([-7, 1, 1, -7], [0, 0, 32, 0], "k-", lw=1, label="Ω_d (4.24)")
    for (name, g), mark in zip(NAMED.items(), "osD", strict=True):
        axis.plot(g.omega, g.alpha, mark, color="w", mec="k", label=name)
    axis.set(
        xlabel="ω", ylabel="α", xlim=(-7.3, 1.3), ylim=(-1, 33), title="Largest β for which (4.25) is feasible, γ = Δk = 0.5"
    )
    axis.legend(loc="upper left")
    return figure


REPRODUCTIONS = (
    Reproduction("lmi-4.25", "Which β the matrix inequality admits", "Proposition 7, (4.24)-(4.36)", inequality),
)
