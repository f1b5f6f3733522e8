"""The decisions, laws and planners of chapter 2.

Marks in the comments: SOURCED from the thesis or from code or text that was read; INFERRED where neither the thesis nor
anything that could be read gives the value.
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from protocol.scenario.table import NonNegative, Positive, Table

Inertia = Annotated[float, Meta(ge=0, lt=1)]
Period = Annotated[float, Meta(gt=0, le=600)]
Draws = Literal["scalar", "per-axis"]


class Pso(Table, frozen=True):
    """Particle swarm optimisation, (2.1)-(2.5), as a decision and as a direct discrete control."""

    inertia: Inertia = 0.9  # omega of (2.2); INFERRED: SOURCED from code of others for this problem, as c1 and c2
    c1: NonNegative = 2.0  # alpha_1 ~ U(0, c1) of (2.3)
    c2: Positive = 2.0  # alpha_2 ~ U(0, c2)
    draws: Draws = "per-axis"  # alpha_j a number per axis (INFERRED), or one as (2.3) prints it (SOURCED)
    sampling: Period = 30.0  # from one direct control signal v_i(k+1) to the next, s; 10, 20, 30 in the thesis (SOURCED)
    recall: NonNegative = 20.0  # x_l, x_g are the best of the latest so many seconds; 0: of all, as printed (SOURCED)
    gain: Positive = 2.0  # of the velocity error, with which the hand takes up v_i, 1/s; INFERRED
    clearance: Positive = 2.5  # d of (3.35), which is added, m; the thesis has no collision avoidance here


class Cpso(Table, frozen=True):
    """Charged particle swarm optimisation [Jatmiko 2007] in the form of [Blackwell 2003]."""

    inertia: Inertia = 0.729844  # chi; SOURCED for Blackwell
    c1: NonNegative = 1.496180  # chi phi_1, phi_1 = 2.05; SOURCED for Blackwell
    c2: Positive = 1.496180
    draws: Draws = "per-axis"
    charge: NonNegative = 30.0  # Q of a charged robot; INFERRED for a field of 100 m
    core: Positive = 1.0  # r_c, m: nearer, the force grows no more; SOURCED for Blackwell
    reach: Positive = 50.0  # r_p, m: farther, there is none; INFERRED (Blackwell: half the side of the start)


class Consensus(Table, frozen=True):
    """The consensus law (2.7), Table 2.1, and the decisions that it follows."""

    alpha: Positive = 0.35  # alpha_i, 1/s (Table 2.1)
    max_speed: Positive = 0.8  # v_max, m/s (Table 2.1)
    sampling: Period = 30.0  # from one decision p_i(k) to the next, s; INFERRED
    gain: Positive = 5.0  # of the velocity error, with which the hand takes up u_i, 1/s; INFERRED
    clearance: Positive = 2.5  # d of (3.35), which is added, m; the thesis has no collision avoidance here


class Spiral(Table, frozen=True):
    """The spiral planner (2.8), (2.9)."""

    a: Positive = 0.1  # m
    b: Positive = 0.4
    turn: Positive = 0.1  # theta falls by this in every step k', rad
    period: Period = 1.0  # of a step k', s; INFERRED
