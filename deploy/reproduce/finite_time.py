"""Printed and finite-time laws side by side: how the logarithm of the error falls, and how long settling takes.

Rules: the laws are those that the robots call, on exact double integrators (1.7) with the input held over 2 ms, unsaturated
and without repulsion; the reference is at rest.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from deploy.reproduce import double_integrators as motion
from deploy.reproduce.kinds import AGREES, DIFFERS, OURS, Options, Reproduction, Result, Row
from deploy.reproduce.settling import consensus_scale, consensus_time, settling_bound
from protocol.scenario.laws import Cfpso, CfpsoFt
from protocol.topology.find import find_graph
from robot_agent.control.homogeneous import Law

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DT = 0.002  # s
BETA, GAMMA, ALPHA = 0.5, 0.9, 0.6  # the example after Proposition 8
X, V = (-9.0, 0.0, 9.0), (20.0 - 4.0 / 3.0, 4.0 - 4.0 / 3.0, -20.0 - 4.0 / 3.0)  # seen from their mean, for round-off's sake
AWAY, MOVING = (5.0,), (-9.0,)  # Figures 4.3 and 4.4: y_1(0), y_2(0)
STARTS = ((0.1, 0.0), (1.0, 0.0), (5.0, 0.0), (0.0, 0.8), (1.0, 0.8), (1.0, -0.8), (5.0, -9.0))
TINY = 1e-9  # errors below it count as settled, m and m/s


def agreement_law() -> Law:
    """The consensus law at the exponent and the gains of the example of (5.1): k1 = beta, k2 = gamma."""
    return Law(ALPHA, BETA, GAMMA)


def tracking_law() -> Law:
    """cfpso-ft's default gains without limits."""
    p = CfpsoFt()
    return Law(p.a1, p.k1, p.k2)


@cache
def runs() -> dict[str, motion.Errors]:
    """The four runs by name of the law."""
    graph, p = find_graph("fig-5.3", 3), Cfpso()
    law = tracking_law()
    enough = 1.05 * settling_bound(law, *AWAY, *MOVING)
    printed = motion.printed_tracking(p.omega, p.alpha, p.a, p.gamma, p.beta, DT)
    return {
        "(5.1)": motion.run(motion.printed_consensus(graph, BETA, GAMMA, ALPHA, DT), X, V, DT, 56.0, agree=True),
        "dcs-ft": motion.run(motion.finite_time_consensus(graph, agreement_law(), DT), X, V, DT, 24.0, agree=True),
        "(4.12)": motion.run(printed, AWAY, MOVING, DT, 34.0, agree=False),
        "cfpso-ft": motion.run(motion.finite_time_tracking(law, DT), AWAY, MOVING, DT, enough, agree=False),
    }


@cache
def settling_times() -> list[tuple[float, float, float, float]]:
    """(e, w, measured, bound) of cfpso-ft from each start; m, m/s, s, s."""
    law = tracking_law()
    table = []
    for e, w in STARTS:
        bound = settling_bound(law, e, w)
        run = motion.run(motion.finite_time_tracking(law, DT), [e], [w], DT, 1.05 * bound, agree=False)
        table.append((e, w, run.settled(TINY, TINY), bound))
    return table


def make(options: Options) -> Result:
    """The pictures and the rows."""
    errors, p = runs(), Cfpso()
    graph = find_graph("fig-5.3", 3)
    slow = motion.exponential_rate(motion.rates(errors["(5.1)"].decade_times(4, 10))[-1])
    tail = motion.exponential_rate(motion.rates(errors["(4.12)"].decade_times(8, 11))[-1])
    there = errors["(5.1)"].x[round(55.32 / DT)]
    bends = {name: motion.rates(errors[name].decade_times(0, 9)) for name in ("dcs-ft", "cfpso-ft")}
    scale = consensus_scale(graph, agreement_law())
    predicted = consensus_time(scale, graph, agreement_law(), X, V)
    agreed = errors["dcs-ft"].settled(TINY, TINY)
    table = settling_times()
    return Result(
        rows=[
            Row(
                "log error of (5.1)",
                "finite-time; stable at T > 55.32 (Remark 22)",
                f"straight line, rate {slow:.4f}/s from 1e-9 to 1e-10 m; beta/gamma = {BETA / GAMMA:.4f}/s",
                DIFFERS,
                f"exponential: on phi = 0 the position obeys gamma y' = -beta y; at 55.32 s it is round-off, {there:.1e} m",
            ),
            Row(
                "log error of (4.12), gains of Table 4.5",
                "finite-time (Proposition 6)",
                f"straight line in the end, rate {tail:.2f}/s; alpha/(1-omega) = {p.alpha / (1.0 - p.omega):.2f}/s",
                DIFFERS,
                "exponential: on phi = 0 the position obeys (1-omega) y' = -alpha y",
            ),
            *(
                Row(
                    f"log error of {name}",
                    "",
                    f"{rates[0]:.2f} decades/s from 1 to 0.1 m, {rates[-1]:.1f} from 1e-8 to 1e-9 m",
                    OURS,
                    "bends down without bound: each decade takes a smaller share of the one before",
                )
                for name, rates in bends.items()
            ),
            Row(
                "settling of dcs-ft, start of the example of (5.1)",
                "",
                f"{agreed:.2f} s to {TINY:g}; numerical bound {predicted:.2f} s",
                OURS,
                "numerical: the longest of 64 sampled starts, carried over by homogeneity; not proved",
            ),
            *(
                Row(
                    f"settling of cfpso-ft from e = {e:g} m, w = {w:g} m/s",
                    "T <= V(0)^(1-g) / (c (1-g)) (Lemma 1)",
                    f"{t:.2f} s to {TINY:g}; proved bound {bound:.2f} s",
                    AGREES if t <= bound else DIFFERS,
                    "V is a strict Lyapunov function; its rate c is verified by interval arithmetic",
                )
                for e, w, t, bound in table
            ),
        ],
        figures={"": _errors_picture(errors), "settling": _settling_picture(table, agreed, predicted)},
        numbers={
            "decades_per_second": {
                name: motion.rates(each.decade_times(0, 9)) for name, each in errors.items()
            },
            "consensus_scale_s": scale,
            "settling": [dict(zip(("e", "w", "measured_s", "bound_s"), row, strict=True)) for row in table],
        },
    )


def _errors_picture(errors: dict[str, motion.Errors]) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 4.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    p = Cfpso()
    _draw(left, errors, ("(5.1)", "dcs-ft"), f"β/γ = {BETA / GAMMA:.3f}/s", "largest |$x_i - x_j$|, m")
    left.set_title("agreement of three robots on a line (Figure 5.3)")
    _draw(right, errors, ("(4.12)", "cfpso-ft"), f"α/(1−ω) = {p.alpha / (1 - p.omega):.2f}/s", "|$x_i - p_i$|, m")
    right.set_title("one robot and its target")
    return figure


def _draw(axes: Axes, errors: dict[str, motion.Errors], names: tuple[str, str], slope: str, what: str) -> None:
    floor = 1e-12
    for name, colour in zip(names, ("tab:red", "tab:blue"), strict=True):
        each = errors[name]
        label = f"{name} as printed: in the end a straight line, {slope}" if name.startswith("(") else f"{name}: bends down"
        # beyond the floor sampled time and round-off are all that is left to see
        last = next((k for k, e in enumerate(each.x) if max(each.x[k:k + 500]) < floor), len(each.x))
        axes.semilogy(each.t[:last:5], [max(e, floor) for e in each.x[:last:5]], color=colour, lw=1.4, label=label)
    axes.set_ylim(floor, 1e2)
    axes.set_xlim(0.0, None)
    axes.set_xlabel("time, s")
    axes.set_ylabel(what)
    axes.grid(alpha=0.3)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, -0.36), frameon=False)


def _settling_picture(table: list[tuple[float, float, float, float]], agreed: float, predicted: float) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 4.2), layout="constrained")
    axes = figure.subplots()
    names = [f"cfpso-ft\ne = {e:g} m\nw = {w:g} m/s" for e, w, _, _ in table] + ["dcs-ft\nstart of\n(5.1)"]
    places = range(len(names))
    axes.bar([k - 0.2 for k in places], [row[2] for row in table] + [agreed], 0.4, label=f"measured, to {TINY:g}")
    axes.bar([k + 0.2 for k in places][:-1], [row[3] for row in table], 0.4, label="proved bound (Lemma 1)")
    axes.bar([len(names) - 0.8], [predicted], 0.4, color="tab:gray", label="numerical bound, not proved")
    axes.set_xticks(list(places), names, fontsize=8)
    axes.set_ylabel("settling time, s")
    axes.grid(axis="y", alpha=0.3)
    axes.legend(frameon=False, loc="upper left")
    return figure


REPRODUCTIONS = (
    Reproduction("finite-time", "Printed laws and truly finite-time ones", "Propositions 6 and 8, Remark 22", make),
)
