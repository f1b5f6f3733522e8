"""The laws of chapter 5."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from protocol.scenario.table import OpenFraction, Positive, Table


class Dcs(Table, frozen=True):
    """The consensus-based laws (5.5), (5.7), Tables 5.3 and 5.4."""

    beta: Positive = 0.5
    gamma: Positive = 2.0
    alpha: OpenFraction = 0.6
    lam: Positive = 0.1  # lambda of (5.5)
    lam1: Positive = 0.1  # lambda_1 of (5.7)
    lam2: Positive = 0.1
    radius: Positive = 5.0  # of the formation h_i, m
    sectors: Annotated[int, Meta(ge=0, le=1000)] = 0  # h_i at 2 pi i / sectors; 0: N (the thesis prints 5)
    circle: Positive = 10.0  # r of the circular motion, m
    orbits: Literal["spread", "one"] = "spread"  # radii r i/N, as Table 5.2 has three, or r for all
    turn: Positive = 0.06  # omega_0, rad/s; printed 0.1 asks r omega_0 = 1.0 m/s of robots that do 0.8
    repulsion: bool = True  # (3.35) added; the thesis has no collision avoidance here
    clearance: Positive = 2.0  # its d for this law, m: below the spacing of the formation
    order: Literal["algorithm-5", "algorithm-2"] = "algorithm-5"  # lost -> circular, or as Algorithm 2 prints it
