"""The experiments of section 5.3: three P3-DX under (5.4) and (5.6) on Figures 5.3 and 5.18, Figures 5.8 to 5.26.

Rules: the swarm itself runs, from the scenario files in deploy/scenarios: robots of section 1.1.3 with their limits, on
the declared graph. The thesis shows curves and prints no number here, no initial state and no v_max; the rows say what
the text claims and what happens.
"""

from __future__ import annotations

from math import atan2, degrees, hypot, pi
from pathlib import Path
from typing import TYPE_CHECKING

import deploy
from deploy.reproduce.chapter5.decay import below, furthest, furthest_pair, rate, seconds
from deploy.reproduce.kinds import AGREES, DIFFERS, OURS, Options, Reproduction, Result, Row
from deploy.reproduce.trajectory import Trajectory, record
from protocol.scenario import Scenario
from protocol.scenario.load import load_scenario
from protocol.topology.analysis import Analysis, analyse
from protocol.topology.graph import Graph
from robot_agent.control.consensus_laws import formation, orbit

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

PERIOD = 0.5  # "we record the data at every 0.5 s"
NEAR = 0.05  # m and m/s: within this the swarm has settled, for a row
# (name, scenario values over the file): r_3 omega_0 is 1.2 m/s as printed, and Table 3.2 gives v_max = 0.8 m/s.
CIRCLES: tuple[tuple[str, dict[str, object]], ...] = (
    ("as printed", {}),
    ("omega_0 = 0.05", {"drill.turn": 0.05}),
    ("v_max = 2", {"body.max_speed": 2.0}),
)


def scenario_of(name: str, seed: int, **values: object) -> Scenario:
    """The scenario file of `name` with `values` over it ("__" for ".")."""
    file = Path(deploy.__file__).parent / "scenarios" / f"{name}.toml"
    chosen = {"seed": seed, **values}
    return load_scenario(file, overrides=[(key.replace("__", "."), value, name) for key, value in chosen.items()])


def parallel_experiment(name: str, options: Options) -> Result:
    """Figures 5.8-5.12, or 5.19-5.22."""
    import numpy as np

    from deploy.reproduce.chapter5.pictures import ways_figure

    s = scenario_of(name, options.seed)
    run = record(s, options.bus, PERIOD)
    p, t = s.drill, run.t
    x, v = run.hands(s.body.hand), run.hand_velocities(s.body.hand)
    apart = furthest_pair(x - np.array(formation(p.radius, p.sectors or s.robots, s.robots)))
    drift = furthest(v, p.velocity)
    speed, heading = hypot(*p.velocity), atan2(p.velocity[1], p.velocity[0])
    turned = np.abs((run.robots[-1, :, 2] - heading + pi) % (2 * pi) - pi)
    slowest = min(p.beta * mu / (p.gamma * mu + p.lam) for mu in _real(analyse(Graph(s.robots, s.graph))))
    start, end = 0.5 * t[-1], t[-1]
    result = Result(numbers=_numbers(run))
    result.rows = [
        _initial(),
        Row("formation, x_i - h_i -> x_j - h_j", "within a finite time (Corollary 2)",
            f"{apart[-1]:.1e} m off at {t[-1]:g} s; within {NEAR} m from {seconds(below(t, apart, NEAR))}", AGREES
            if apart[-1] < NEAR else DIFFERS),
        Row("rate of its tail", "a finite time", f"{rate(t, apart, start, end):.3f} /s; min beta mu / (gamma mu + lambda)"
            f" = {slowest:.3f} /s", DIFFERS, "exponential, as for the double integrators"),
        Row("linear velocity", f"v_c = (0.4, -0.2): {speed:.3f} m/s", f"{run.robots[-1, :, 3].min():.4f} to"
            f" {run.robots[-1, :, 3].max():.4f} m/s, within {NEAR} m/s of v_c from {seconds(below(t, drift, NEAR))}", AGREES
            if drift[-1] < NEAR else DIFFERS),
        Row("heading", f"{degrees(heading):.1f} degrees", f"within {degrees(turned.max()):.1e} degrees", AGREES
            if turned.max() < 0.02 else DIFFERS),
        *_common(run, s),
    ]  # fmt: skip
    joined = [int(np.argmin(np.abs(t - at))) for at in np.linspace(0.0, t[-1], 7)]
    result.figures[""] = ways_figure(x, joined, f"Parallel movement on {s.topology}")
    result.figures["curves"] = _curves(run, s)
    return result


def circular_experiment(name: str, options: Options) -> Result:
    """Figures 5.13-5.17, or 5.23-5.26: as printed, and so that the robots can do it."""
    result = Result(rows=[_initial()])
    for title, values in CIRCLES:
        s = scenario_of(name, options.seed, **values)
        _circle(result, title, s, record(s, options.bus, PERIOD))
    return result


def _circle(result: Result, title: str, s: Scenario, run: Trajectory) -> None:
    import numpy as np

    from deploy.reproduce.chapter5.pictures import ways_figure

    p, t, x = s.drill, run.t, run.hands(s.body.hand)
    theta = 2 * pi / s.robots * np.arange(1, s.robots + 1) + p.turn * t[:, None]
    h = np.array([[orbit(r, p.turn, each)[0] for r, each in zip(p.radii, row, strict=True)] for row in theta])
    off = np.linalg.norm(x - h - p.centre, axis=2)
    last = t > t[-1] - 2 * pi / p.turn
    radii, nus = np.linalg.norm(x[last] - p.centre, axis=2), run.robots[last, :, 3]
    asked = ", ".join(f"{r * p.turn:g}" for r in p.radii)
    can = max(p.radii) * abs(p.turn) <= s.body.max_speed
    settled = below(t, off.max(axis=1), NEAR)
    result.rows += [
        Row(f"{title}: speeds asked, r_i omega_0", "no v_max printed here; 0.8 in Table 3.2",
            f"{asked} m/s of robots that do {s.body.max_speed:g} m/s", OURS, "" if can else "cannot be driven"),
        Row(f"{title}: radii in the last turn", "3, 8 and 12 m",
            ", ".join(f"{low:.2f} to {high:.2f}" for low, high in zip(radii.min(0), radii.max(0), strict=True)) + " m",
            AGREES if np.abs(radii - p.radii).max() < NEAR else DIFFERS),
        Row(f"{title}: settled, all within {NEAR} m of their places", "within a finite time (Corollary 3)", seconds(settled),
            AGREES if settled is not None else DIFFERS),
        Row(f"{title}: mean speeds in the last turn", "", ", ".join(f"{each:.3f}" for each in nus.mean(0)) + " m/s", OURS),
        *_common(run, s, f"{title}: "),
    ]  # fmt: skip
    result.numbers[title] = _numbers(run)
    ending = title.replace(" ", "-").replace("=", "").replace("--", "-")
    result.figures[ending] = ways_figure(x, (), f"Circular movement on {s.topology}, {title}")
    result.figures[f"{ending}-curves"] = _curves(run, s)


def _initial() -> Row:
    note = "places and headings of the scenario file; other ones give other ways to the same motion"
    return Row("initial state and duration", "not printed", "chosen", OURS, note)


def _common(run: Trajectory, s: Scenario, before: str = "") -> list[Row]:
    """What all experiments say of the run."""
    nearest = run.outcome.min_pair_distance or 0.0
    kept = "(3.35) never acts" if nearest >= s.drill.clearance else "(3.35) acts within 2 m"
    rows = [Row(f"{before}nearest pair", "", f"{nearest:.2f} m", OURS, kept)]
    if run.missed:
        rows.append(Row(f"{before}samples that did not arrive", "", str(run.missed), OURS, "telemetry is best effort"))
    return rows


def _real(analysis: Analysis) -> list[float]:
    return [value.real for value in analysis.nonzero]


def _numbers(run: Trajectory) -> dict[str, object]:
    o = run.outcome
    return {"digest": o.digest, "ticks": o.ticks, "ticks_per_s": o.ticks_per_s, "missed": run.missed,
            "min_pair_distance": o.min_pair_distance, "distance_travelled": o.distance_travelled}  # fmt: skip


def _curves(run: Trajectory, s: Scenario) -> Figure:
    """Linear and angular velocity, heading, torques as the wheels give them."""
    import numpy as np

    from deploy.reproduce.chapter5.pictures import curves_figure

    top = s.body.max_torque
    theta, nu, omega, left, right = np.moveaxis(run.robots[:, :, 2:7], 2, 0)
    panels = {
        "linear velocity, m/s": nu,
        "angular velocity, rad/s": omega,
        "heading, rad": theta,
        "torque, left wheel, N m": np.clip(left, -top, top),
        "torque, right wheel, N m": np.clip(right, -top, top),
    }
    limits = {"linear velocity, m/s": s.body.max_speed}
    return curves_figure(run.t, panels, limits)


def _parallel(name: str, figures: str, graph: str) -> Reproduction:
    title = f"parallel motion (5.4) of three robots on {graph}"
    return Reproduction(name, title, f"section 5.3, {figures}", lambda o: parallel_experiment(name, o), swarm=True)


def _circular(name: str, figures: str, graph: str) -> Reproduction:
    title = f"circular motion (5.6) of three robots on {graph}"
    return Reproduction(name, title, f"section 5.3, {figures}", lambda o: circular_experiment(name, o), swarm=True)


ROBOTS = (
    _parallel("fig-5.8", "Figures 5.8-5.12", "a line"),
    _circular("fig-5.13", "Figures 5.13-5.17", "a line"),
    _parallel("fig-5.19", "Figures 5.19-5.22", "the complete graph"),
    _circular("fig-5.23", "Figures 5.23-5.26", "the complete graph"),
)
