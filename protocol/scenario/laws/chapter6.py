"""The laws of chapter 6."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from protocol.scenario.table import NonNegative, Positive, Real, Table

Action = Annotated[float, Meta(gt=0, le=1000)]


class Ftmcs(Table, frozen=True):
    """The potential-based laws (6.2), (6.4), (6.5), Tables 6.1 and 6.2, section 6.4."""

    q: Annotated[float, Meta(gt=0.5, lt=1)] = 0.6  # exponent of all laws, (2a-1)/(2a+1); (6.2) needs more than 1/2
    gamma: Positive = 1.0  # pull towards the neighbours' virtual velocities and the reference
    lam: Positive = 0.4  # lambda of (6.4)
    beta: Positive = 0.5  # slope of the potential in (6.4)
    circle_lam: Positive = 0.6  # lambda of (6.5)
    circle_beta: Positive = 0.3  # beta of (6.5)
    k: Positive = 7.0  # of the tracking law (6.2)
    k1: Positive = 0.5
    d: Positive = 7.0  # distance that the potential wants while the group traces, m
    circle_d: Positive = 2.5  # and while it circles, m
    reach: Annotated[float, Meta(gt=1, le=100)] = 1.2  # range of the potential r = reach d
    attack: Action = 5.0  # a of Olfati-Saber's action function: attraction
    defence: Action = 5.0  # b: repulsion; at least a
    epsilon: Positive = 0.1  # of the sigma-norm
    h: Annotated[float, Meta(ge=0, lt=1)] = 0.2  # of the bump function
    circle: Positive = 15.0  # R, m
    turn: Real = 0.04  # omega_0, rad/s; printed 0.1 asks R omega_0 = 1.5 m/s of robots that do 0.8
    centre: Literal["smelt", "decided"] = "smelt"  # of the circle: where the odour was met last, or h^ic as printed
    circle_reach: Literal["all", "cut"] = "all"  # the virtual robot of (6.5) is felt at any distance, or within r
    search: Literal["free", "parallel"] = "free"  # the potential acts from the first detection on, or from the start
    reference: Literal["smelt", "all"] = "smelt"  # whose v_c^i counts in (6.4): of whoever smelt last, or everyone's
    leash: NonNegative = 1.0  # the virtual robot stays this near to the real one, m; 0: it may run away
    limited: bool = True  # the virtual position moves no faster than a robot drives
    repulsion: bool = True  # (3.35) is added within `clearance` for whoever the potential does not see
    clearance: Positive = 2.0  # its d for this law, m
