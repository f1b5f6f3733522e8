"""The experiments of section 6.3: three P3-DX under (6.3) and (6.5), Tables 6.1 and 6.2, Figures 6.10 to 6.19.

Rules: the swarm itself runs, from the scenario files in deploy/scenarios: robots of section 1.1.3 with their limits, each
with its own virtual robot. The thesis shows curves and prints no number here, no graph and no initial state; the rows
say what the text claims and what happens.
"""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, pi, sin
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import deploy
from deploy.reproduce.chapter6.virtual_robots import Array, distances, settled
from deploy.reproduce.kinds import AGREES, DIFFERS, OURS, Options, Reproduction, Result, Row
from deploy.reproduce.trajectory import Trajectory, record
from protocol.scenario import Scenario
from protocol.scenario.load import load_scenario

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PERIOD = 0.5  # s between samples
NEAR = 0.05  # m and m/s: within this the swarm has settled, for a row


def scenario_of(name: str, seed: int, **values: object) -> Scenario:
    """The scenario file of `name` with `values` over it ("__" for ".")."""
    file = Path(deploy.__file__).parent / "scenarios" / f"{name}.toml"
    chosen = {"seed": seed, **values}
    return load_scenario(file, overrides=[(key.replace("__", "."), value, name) for key, value in chosen.items()])


def parallel(options: Options, **values: object) -> Result:
    """Figures 6.10-6.14."""
    from deploy.reproduce.chapter5.pictures import ways_figure

    s = scenario_of("fig-6.10", options.seed, **values)
    run = record(s, options.bus, PERIOD)
    t, v_c = run.t, s.drill.velocity
    x, v = run.hands(s.body.hand), run.hand_velocities(s.body.hand)
    gaps = _pairs(x)
    stretched = np.abs(gaps - s.ftmcs.d).max(axis=1)
    drift = np.linalg.norm(v - v_c, axis=2).max(axis=1)
    heading = atan2(v_c[1], v_c[0])
    turned = float(np.abs((run.robots[-1, :, 2] - heading + pi) % (2 * pi) - pi).max())
    result = Result(numbers=_numbers(run))
    result.rows = [
        _initial(),
        Row(
            "distances of the three pairs at the end",
            f"d = {s.ftmcs.d:g} m",
            ", ".join(f"{gap:.3f}" for gap in gaps[-1]) + " m",
            AGREES if stretched[-1] < NEAR else DIFFERS,
            f"within {NEAR} m from {settled(t, stretched, NEAR):.1f} s on",
        ),
        Row(
            "linear velocity",
            f"v_c = (0.4, -0.2): {hypot(*v_c):.3f} m/s",
            f"{run.robots[-1, :, 3].min():.4f} to {run.robots[-1, :, 3].max():.4f} m/s",
            AGREES if drift[-1] < NEAR else DIFFERS,
            f"within {NEAR} m/s of v_c from {settled(t, drift, NEAR):.1f} s on",
        ),
        Row(
            "heading",
            f"{degrees(heading):.1f} degrees",
            f"within {degrees(turned):.1e} degrees",
            AGREES if turned < 0.02 else DIFFERS,
        ),
        *_common(run),
    ]
    joined = [int(np.argmin(np.abs(t - at))) for at in np.linspace(0.0, t[-1], 7)]
    result.figures[""] = ways_figure(x, joined, "Figure 6.10: parallel movement by (6.3)")
    result.figures["curves"] = _curves(run, s)
    return result


def circular(options: Options, **values: object) -> Result:
    """Figures 6.15-6.19."""
    from deploy.reproduce.chapter5.pictures import ways_figure

    s = scenario_of("fig-6.15", options.seed, **values)
    run = record(s, options.bus, PERIOD)
    p, t = s.ftmcs, run.t
    x, v = run.hands(s.body.hand), run.hand_velocities(s.body.hand)
    arm = np.array([(cos(p.turn * at), sin(p.turn * at)) for at in t]) * p.circle
    to_leader = np.linalg.norm(x - (arm + s.drill.centre)[:, None], axis=2)
    h_r_dot = np.stack([-p.turn * arm[:, 1], p.turn * arm[:, 0]], axis=1)
    drift = np.linalg.norm(v - h_r_dot[:, None], axis=2).max(axis=1)
    late = t > 0.5 * t[-1]
    gaps = _pairs(x)[late]
    result = Result(numbers=_numbers(run))
    result.rows = [
        _initial(),
        Row("speed asked, R omega_0", "8 m, 0.02 rad/s", f"{p.circle * p.turn:g} m/s", OURS, "can be driven"),
        Row(
            "velocities from h_r' in the second half of the run",
            "v_i -> h_r' within a finite time",
            f"at most {drift[late].max():.1e} m/s",
            AGREES if drift[late].max() < NEAR else DIFFERS,
            f"within {NEAR} m/s from {settled(t, drift, NEAR):.1f} s on",
        ),
        Row(
            "distances from the virtual robot, second half",
            f"d = {p.circle_d:g} m in the minimum of the extended J",
            f"{to_leader[late].min():.2f} to {to_leader[late].max():.2f} m",
            AGREES if np.abs(to_leader[late] - p.circle_d).max() < 0.1 * p.circle_d else DIFFERS,
            "r = 9 m lets all four draw each other: they rest in a square, its sides below d and its diagonals above",
        ),
        Row(
            "distances of the pairs, second half",
            f"d = {p.circle_d:g} m",
            f"{gaps.min():.2f} to {gaps.max():.2f} m",
            AGREES if np.abs(gaps - p.circle_d).max() < 0.1 * p.circle_d else DIFFERS,
            "four points cannot all be at one distance in the plane",
        ),
        *_common(run),
    ]
    result.figures[""] = figure = ways_figure(x, (), "Figure 6.15: circular movement by (6.5)")
    (axis,) = figure.axes
    axis.plot(*(arm + s.drill.centre).T, "r--", lw=1, label="virtual robot h_r")
    axis.plot(*s.drill.centre, "k+", ms=12, mew=2, label="h^c")
    axis.legend(loc="lower right", fontsize=8)
    result.figures["curves"] = _curves(run, s, until=40.0)
    return result


def _pairs(x: Array) -> Array:
    """Distances of the pairs, shape (K, N (N - 1) / 2), m."""
    i, j = np.triu_indices(x.shape[1], 1)
    return distances(x)[:, i, j]


def _initial() -> Row:
    note = "places, headings and the complete graph of the scenario file"
    return Row("initial state, graph, duration", "not printed", "chosen", OURS, note)


def _common(run: Trajectory) -> list[Row]:
    rows = [Row("nearest pair", "", f"{run.outcome.min_pair_distance or 0.0:.2f} m", OURS)]
    if run.missed:
        rows.append(Row("samples that did not arrive", "", str(run.missed), OURS, "telemetry is best effort"))
    return rows


def _numbers(run: Trajectory) -> dict[str, object]:
    o = run.outcome
    return {
        "digest": o.digest,
        "ticks": o.ticks,
        "ticks_per_s": o.ticks_per_s,
        "missed": run.missed,
        "min_pair_distance": o.min_pair_distance,
        "distance_travelled": o.distance_travelled,
    }


def _curves(run: Trajectory, s: Scenario, until: float = 1e9) -> Figure:
    """Linear and angular velocity, heading, torques as the wheels give them, up to `until`, s: then nothing changes."""
    from deploy.reproduce.chapter5.pictures import curves_figure

    shown = run.t <= until
    top = s.body.max_torque
    theta, nu, omega, left, right = np.moveaxis(run.robots[shown, :, 2:7], 2, 0)
    panels = {
        "linear velocity, m/s": nu,
        "angular velocity, rad/s": omega,
        "heading, rad": theta,
        "torque, left wheel, N m": np.clip(left, -top, top),
        "torque, right wheel, N m": np.clip(right, -top, top),
    }
    return curves_figure(run.t[shown], panels, {"linear velocity, m/s": s.body.max_speed})


REPRODUCTIONS = (
    Reproduction(
        "fig-6.10", "parallel motion (6.3) of three robots", "section 6.3, Figures 6.10-6.14", parallel, swarm=True
    ),
    Reproduction(
        "fig-6.15", "circular motion (6.5) of three robots", "section 6.3, Figures 6.15-6.19", circular, swarm=True
    ),
)
