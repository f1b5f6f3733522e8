"""Exercises: the motion laws alone, with references that are given and no odour."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.scenario.table import OpenFraction, Point, Positive, Real, Table


class Drill(Table, frozen=True):
    """Gains of (5.1)-(5.6), Tables 5.1 and 5.2, and the references of an exercise, the same for all robots."""

    beta: Positive = 0.5
    gamma: Positive = 1.2
    alpha: OpenFraction = 0.4
    lam: Positive = 2.0  # lambda of (5.4)
    lam1: Positive = 3.2  # lambda_1 of (5.6)
    lam2: Positive = 3.2
    velocity: Point = (0.4, -0.2)  # v_c, m/s (Table 5.1)
    centre: Point = (0.0, 0.0)  # h^c, m (Table 5.2)
    radius: Positive = 5.0  # of the formation h_i, m (section 5.3)
    sectors: Annotated[int, Meta(ge=0, le=1000)] = 0  # h_i at 2 pi i / sectors; 0: N
    radii: tuple[Positive, ...] = (10.0,)  # r_i of the circles, m: one per robot, or one for all (Table 5.2: 3, 8, 12)
    turn: Real = 0.06  # omega_0, rad/s; printed 0.1 asks r omega_0 = 1.2 m/s of robots that do 0.8
    repulsion: bool = True  # (3.35) added when somebody is near; the thesis has no collision avoidance here
    clearance: Positive = 2.0  # its d for these laws, m
