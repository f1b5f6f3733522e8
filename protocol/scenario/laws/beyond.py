"""Beyond the thesis: `plume-map`. No value is from the thesis; how they were chosen stands in docs/plume-map.md."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.scenario.table import NonNegative, OpenFraction, Positive, Table


class PlumeMap(Table, frozen=True):
    """Events, map, planner and formation of `plume-map`."""

    # events
    window: Annotated[int, Meta(ge=2, le=120)] = 12  # decisions for which an event is kept, told and taken
    wind_memory: Annotated[int, Meta(ge=2, le=600)] = 110  # own wind samples behind a back-trajectory
    smooth: Annotated[float, Meta(gt=0, le=1)] = 0.1  # share of a position reading in the own position, per tick
    # map
    cell: Annotated[float, Meta(ge=0.1, le=20)] = 0.9  # m: where the way is known well; four times as long where it is not
    reach: Positive = 0.9  # r: half width of a plume that is smelt, m
    upwind: NonNegative = 0.42  # how far upwind of a source it is smelt, the mean over places beside it, m
    blur: Positive = 0.7  # sigma_0: the half width's and the way's deviation at lag 0 together, m
    spread: NonNegative = 0.02  # least D, m^2/s
    meander: NonNegative = 1.0  # k_D: D = spread + k_D 5 s var(wind); how the second part acts: robot_agent/plume/map.py
    detect: OpenFraction = 0.9  # p_m: smelt when the plume passes
    false: OpenFraction = 0.03  # p_fa: smelt without a plume
    hit: Positive = 0.7  # weight of a hit
    miss: NonNegative = 0.8  # weight of a miss at lag 0
    tau: Positive = 10.0  # tau_c: a miss counts 1 / (1 + lag / tau_c), s
    thin: Annotated[int, Meta(ge=1, le=10)] = 5  # far parts of misses are drawn every so many decisions, as often as heavy
    forget: Positive = 150.0  # T_f, s
    # planner
    lost_after: Positive = 10.0  # without a hit for so long the group casts, s
    contact: NonNegative = 3.0  # a hit within so long keeps the group on its upwind leg, s
    steady: Positive = 20.0  # the direction of the wind is a mean over so long, s
    shuttle_min: Positive = 1.5  # half a leg along the wind about the estimate, m
    shuttle_max: Positive = 8.0
    cast_max: Positive = 15.0  # half a leg across the wind when lost, m
    sway: NonNegative = 0.7  # half of the way sideways from leg to leg when the source is nearly known, m
    turn_after: Positive = 15.0  # a leg takes no longer, s
    margin: NonNegative = 1.0  # goals stay so far inside the arena, m
    # formation
    speed: Positive = 0.8  # m/s
    spacing_min: Positive = 2.0  # m
    spacing_max: Positive = 6.0  # m
    pull: Positive = 0.5  # to the own place in the line, 1/s
    gain: Positive = 2.0  # of the velocity error, 1/s
    settle: Positive = 0.3  # no faster to the own place while the group is under way in the plume, m/s
    clearance: NonNegative = 1.5  # within this (3.35) acts, m
    proximity: NonNegative = 3.0  # other robots are sensed so far, when `sensors.proximity` is not given, m
