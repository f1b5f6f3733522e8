"""Double integrators (1.7) on one axis under the printed and the finite-time laws, and how fast their errors fall.

Rules: the laws are the functions that the robots call, with the input held over a tick; only the motion is made here,
exactly for a held input:  v + dt u,  x + dt v + dt^2 u / 2. One axis is enough: the laws treat each axis for itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import log10

from protocol.topology.graph import Graph
from robot_agent.control import consensus_laws, dcs_ft
from robot_agent.control.consensus_laws import Motion
from robot_agent.control.homogeneous import Law, pull
from robot_agent.sig import STEPS

Control = Callable[[list[float], list[float]], list[float]]  # u of all robots from their x and v


@dataclass(frozen=True, slots=True)
class Errors:
    """The largest errors of a run over time."""

    t: list[float]  # s
    x: list[float]  # m
    v: list[float]  # m/s

    def settled(self, x: float, v: float) -> float:
        """From when on both errors stay within x, m, and v, m/s; s."""
        late = [k for k, (e, w) in enumerate(zip(self.x, self.v, strict=True)) if e > x or w > v]
        last = late[-1] if late else -1
        return self.t[last + 1] if last + 1 < len(self.t) else float("inf")

    def decade_times(self, first: int, last: int) -> list[float]:
        """When the position error is below 10^-n for good, for n = first ... last, s."""
        return [self.settled(10.0**-n, float("inf")) for n in range(first, last + 1)]


def run(control: Control, x: Sequence[float], v: Sequence[float], dt: float, seconds: float, agree: bool) -> Errors:
    """Let the robots move; errors are differences between robots (`agree`) or distances from 0."""
    xs, vs = list(x), list(v)
    spread = _spread if agree else _size
    ts, ex, ev = [0.0], [spread(xs)], [spread(vs)]
    for k in range(1, round(seconds / dt) + 1):
        us = control(xs, vs)
        xs = [x + dt * (v + 0.5 * dt * u) for x, v, u in zip(xs, vs, us, strict=True)]
        vs = [v + dt * u for v, u in zip(vs, us, strict=True)]
        ts.append(k * dt)
        ex.append(spread(xs))
        ev.append(spread(vs))
    return Errors(ts, ex, ev)


def printed_consensus(graph: Graph, beta: float, gamma: float, alpha: float, dt: float) -> Control:
    """(5.1) as the robots compute it."""
    heard = _hearing(graph)
    dt_k = 2.0 * dt * gamma * max(sum(a for a, _ in row) for row in heard)

    def control(x: list[float], v: list[float]) -> list[float]:
        moves = [Motion(x_i, 0.0, v_i, 0.0) for x_i, v_i in zip(x, v, strict=True)]
        phis = [
            consensus_laws.agreement(own, [(a, moves[j]) for a, j in row], beta, gamma)
            for own, row in zip(moves, heard, strict=True)
        ]
        return [consensus_laws.respond(phi, alpha, STEPS["implicit"], dt_k)[0] for phi in phis]

    return control


def finite_time_consensus(graph: Graph, law: Law, dt: float, held: bool = True) -> Control:
    """The consensus of dcs-ft; `held` = False: the explicit step of the law of continuous time."""
    heard = _hearing(graph)
    K = 2.0 * max(sum(a for a, _ in row) for row in heard)

    def control(x: list[float], v: list[float]) -> list[float]:
        moves = [Motion(x_i, 0.0, v_i, 0.0) for x_i, v_i in zip(x, v, strict=True)]
        return [
            dcs_ft.agreement(own, [(a, moves[j]) for a, j in row], law, dt if held else 0.0, K)[0]
            for own, row in zip(moves, heard, strict=True)
        ]

    return control


def printed_tracking(omega: float, alpha: float, a: float, gamma: float, beta: float, dt: float) -> Control:
    """(4.12) with p = 0, as the robots compute it."""
    inertia = 1.0 - omega
    dt_k = dt * (inertia + dt * alpha)
    step = STEPS["implicit"]
    return lambda x, v: [
        -step(inertia * v_i + alpha * x_i, gamma, beta, a, dt_k) for x_i, v_i in zip(x, v, strict=True)
    ]


def finite_time_tracking(law: Law, dt: float, held: bool = True) -> Control:
    """The law of cfpso-ft with p = 0."""
    return lambda x, v: [pull(law, -x_i, -v_i, dt if held else 0.0, 1.0) for x_i, v_i in zip(x, v, strict=True)]


def rates(times: Sequence[float]) -> list[float]:
    """Decades per second between successive `decade_times`."""
    return [1.0 / (b - a) if b > a else float("inf") for a, b in pairwise(times)]


def exponential_rate(decades_per_second: float) -> float:
    """The rate r of exp(-r t) with that slope, 1/s."""
    return decades_per_second / log10(2.718281828459045)


def _hearing(graph: Graph) -> list[list[tuple[float, int]]]:
    return [[(a_ij, j) for k, j, a_ij in graph.edges if k == i] for i in range(graph.robots)]


def _spread(values: list[float]) -> float:
    return max(values) - min(values)


def _size(values: list[float]) -> float:
    return max(abs(value) for value in values)
