"""Truly finite-time laws of second order, beside the printed ones.

Exponents: a1 stands in the table; a2 = 2 a1 / (1 + a1) follows from it (robot_agent.control.homogeneous).
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from protocol.scenario.table import NonNegative, OpenFraction, Positive, Table


class CfpsoFt(Table, frozen=True):
    """The homogeneous finite-time form of (4.12)."""

    a1: OpenFraction = 0.5  # of the position; the a of Table 4.5
    k1: Positive = 0.5  # position gain, m^(1-a1)/s^2
    k2: Positive = 0.55  # velocity gain; a position term at its limit drives at (0.45 / k2)^(1/a2) = 0.74 m/s
    position_limit: Positive = 0.45  # of the position term per axis, m/s^2; the wheels give 0.90
    velocity_limit: Positive = 0.45  # of the velocity term
    repulsion: bool = True  # (3.35) added


class DcsFt(Table, frozen=True):
    """The homogeneous finite-time form of (5.5), (5.7)."""

    a1: OpenFraction = 0.6  # of the positions; the alpha of Table 5.3
    k1: Positive = 0.5  # position gain of an edge
    k2: Positive = 0.6  # velocity gain of an edge
    k3: NonNegative = 0.6  # velocity gain towards v_c (5.5); 0: consensus alone, (5.3)
    k4: Positive = 0.2  # position gain towards the circle (5.7)
    k5: Positive = 0.3  # velocity gain towards the circle
    position_limit: Positive = 0.3  # of all position terms of the neighbours together, per axis, m/s^2
    velocity_limit: Positive = 0.2  # of all their velocity terms
    reference_limit: Positive = 0.2  # of a term towards the reference; twice that for k3, which is alone; 0.90 in all
    radius: Positive = 5.0  # of the formation h_i, m
    sectors: Annotated[int, Meta(ge=0, le=1000)] = 0  # h_i at 2 pi i / sectors; 0: N
    circle: Positive = 10.0  # r of the circular motion, m
    orbits: Literal["spread", "one"] = "spread"  # radii r i/N, as with dcs, or r for all
    turn: Positive = 0.06  # omega_0, rad/s
    repulsion: bool = True  # (3.35) added
    clearance: Positive = 2.0  # its d for this law, m
