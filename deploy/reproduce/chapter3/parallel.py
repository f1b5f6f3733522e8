"""Example 3, Figure 3.5: three robots come to move in parallel under the robots' law (3.34) with (3.35).

Rules: the robots are the double integrators (1.7), which the example is about, with 9 m/s no wheels could give. Neither
the initial states nor the graph are given: all hear all, and places are drawn in a square of 12 m.
"""

from __future__ import annotations

from math import inf

import numpy as np

from deploy.reproduce.chapter4.pictures import panels
from deploy.reproduce.kinds import AGREES, DIFFERS, OURS, Options, Reproduction, Result, Row
from protocol.messages import Reading, Shared
from protocol.randomness import rng_for
from protocol.scenario import RobotScenario, robot_view
from protocol.scenario.load import load_scenario
from robot_agent.algorithms import ALGORITHMS
from robot_agent.control.simple import SimpleControl
from robot_agent.hand import Own
from robot_agent.interfaces import TRACE, Plan

N, V_C, SECONDS, DT, SIDE = 3, (9.0, -9.0), 40.0, 0.025, 12.0
STARTS = 12
SHOWN = 3.0  # s, in the picture


def move(seed: int, form: str) -> tuple[np.ndarray, np.ndarray]:
    """Places (K, N, 2), m, and velocities (K, N, 2), m/s, from a drawn start; `form` is `repulsion.form`."""
    named = (
        ("robots", N),
        ("algorithm", "simple"),
        ("topology", "all"),
        ("simple.delta", 0.1),
        ("simple.a", 0.5),
        ("repulsion.kappa", 0.8),
        ("repulsion.d", 4.0),
        ("repulsion.d0", 6.6),
        ("repulsion.form", form),
    )
    scenario = load_scenario(None, overrides=[(*pair, "Example 3") for pair in named], algorithms=ALGORITHMS)
    views = [robot_view(scenario, i) for i in range(N)]
    laws = [SimpleControl(view) for view in views]
    rng = rng_for(seed, "reproduce", "fig-3.5")
    x = np.array([[SIDE * (rng.uniform() - 0.5) for _ in range(2)] for _ in range(N)])
    v = np.array([[4.0 * (rng.uniform() - 0.5) for _ in range(2)] for _ in range(N)])
    plan = Plan(TRACE, target=(0.0, 0.0), v_c=V_C)
    places, velocities = [x.copy()], [v.copy()]
    for _ in range(round(SECONDS / DT)):
        owns = [_own(i, x[i], v[i], views[i]) for i in range(N)]
        states = [_shared(i, x[i], v[i]) for i in range(N)]
        u = np.array(
            [
                laws[i].control(
                    owns[i],
                    [(1.0, states[j]) for j in range(N) if j != i],
                    [(*x[j], *v[j]) for j in range(N) if j != i],
                    plan,
                    DT,
                )
                for i in range(N)
            ]
        )
        x, v = x + DT * (v + 0.5 * DT * u), v + DT * u
        places.append(x)
        velocities.append(v)
    return np.array(places), np.array(velocities)


def agreed(v: np.ndarray, band: float) -> float:
    """From when on every robot drives within `band` of v_c, s; inf: not within the run."""
    off = np.linalg.norm(v - V_C, axis=2).max(axis=1)
    outside = np.flatnonzero(off >= band)
    last = int(outside[-1]) if len(outside) else -1
    return (last + 1) * DT if last + 1 < len(off) else inf


def example_3(options: Options) -> Result:
    """With the potential added the group moves in parallel; with the potential in its place it does not."""
    rows: list[Row] = []
    numbers: dict[str, object] = {}
    for form in ("sum", "switch"):
        runs = [move(options.seed + k, form) for k in range(STARTS)]
        times = [agreed(v, 0.05) for _, v in runs]
        there = [time for time in times if time < inf]
        nearest = min(float(_distances(x).min()) for x, _ in runs)
        left = float(np.median([np.linalg.norm(v[-1] - V_C, axis=1).max() for _, v in runs]))
        final = np.array([np.sort(_distances(x[-1:])[0]) for x, _ in runs])
        numbers[form] = {"settled_s": [t if t < inf else None for t in times], "nearest_m": nearest, "final_m": final}
        said = "added to (3.34)" if form == "sum" else "in the place of (3.34) within d_0, as printed"
        rows += [
            Row(
                f"{len(there)} of {STARTS} starts come within 0.05 m/s of v_c, (3.35) {said}",
                "parallel movement (Figure 3.5)",
                f"median {np.median(there):.1f} s" if there else f"median error at the end {left:.2f} m/s",
                AGREES if len(there) == STARTS else DIFFERS,
                "" if form == "sum" else "d_0 = 6.6 > d = 4: near each other the robots feel neither v_c nor any damping",
            ),
            Row(
                "  distances at the end (median), nearest ever",
                "",
                ", ".join(f"{d:.2f}" for d in np.median(final, axis=0)) + f"; {nearest:.2f} m",
                OURS,
                "the starts, which are drawn, included; (3.35) rests at d = 4 m",
            ),
        ]
    figure, axes = panels(2)
    for axis, form in zip(axes, ("sum", "switch"), strict=True):
        x, _ = move(options.seed, form)
        shown = slice(0, round(SHOWN / DT) + 1)
        for i in range(N):
            axis.plot(*x[shown, i].T, lw=1)
            axis.plot(*x[0, i], "ko", mfc="none")
            axis.plot(*x[shown.stop - 1, i], "k*")
        axis.set(xlabel="x, m", ylabel="y, m", aspect="equal", title=f"first {SHOWN:g} s, repulsion.form = {form}")
    return Result(rows, {"": figure}, numbers)


def _distances(x: np.ndarray) -> np.ndarray:
    """Distances of all pairs, (K, pairs), m."""
    pairs = [(i, j) for i in range(N) for j in range(i + 1, N)]
    return np.stack([np.linalg.norm(x[:, i] - x[:, j], axis=1) for i, j in pairs], axis=1)


def _own(i: int, x: np.ndarray, v: np.ndarray, view: RobotScenario) -> Own:
    own = Own(Reading(i, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), view.body)
    own.x, own.y, own.vx, own.vy = map(float, (*x, *v))
    return own


def _shared(i: int, x: np.ndarray, v: np.ndarray) -> Shared:
    px, py, vx, vy = map(float, (*x, *v))
    return Shared(i, 0, px, py, vx, vy, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 0.0, 0.0, 0.0)


REPRODUCTIONS = (Reproduction("fig-3.5", "Three robots in parallel", "Example 3, Figure 3.5", example_3),)
