"""The tables of a scenario file, one frozen record each; a comment gives symbol, unit and source.

Rules: every value has a default that works (the `corrected` preset); bounds stand in the type; SI units and radians;
concentration in ppt. What a robot may know and what only the world knows are different tables, so that a robot's
scenario can leave the truth out by leaving tables out (see `robot_view`). Switches that depart from the thesis are
listed in docs/departures.md. The tables of the control laws and algorithms stand in `protocol.scenario.laws`.
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from protocol.scenario.table import Fraction, NonNegative, OpenFraction, Point, Positive, Real, Table


class Arena(Table, frozen=True):
    """The search area."""

    x_min: Real = 0.0
    x_max: Real = 100.0
    y_min: Real = -50.0
    y_max: Real = 50.0


class Source(Table, frozen=True):
    """Where the odour comes from. Only the world knows."""

    x: Real = 10.0  # x_s, m (Table 4.6)
    y: Real = 0.0
    radius: Positive = 1.0  # found when a robot's hand is this close, m
    stop: Literal["circle", "concentration"] = "circle"  # what counts as found; chapter 2: a concentration
    stop_concentration: Positive = 19515.0  # found when a robot senses as much, ppt (section 2.4.1)


class Wind(Table, frozen=True):
    """The wind field (1.2), (1.3)."""

    speed: Annotated[float, Meta(gt=0, le=20)] = 1.0  # mean wind, m/s (Table 1.1: 0.8, 1.0, 1.5)
    direction: Annotated[float, Meta(ge=-6.3, le=6.3)] = 0.0  # where the mean wind blows to, rad from the x axis
    diffusivity: NonNegative = 10.0  # K_x = K_y, m^2/s (Table 1.1)
    gain: Annotated[float, Meta(ge=0, le=20)] = 0.15  # G of the corner noise; the thesis gives none
    bandwidth: Positive = 0.2  # w of the corner noise, rad/s
    damping: Annotated[float, Meta(gt=0, lt=1)] = 0.1  # zeta of the corner noise
    nodes: Annotated[int, Meta(ge=3, le=201)] = 21  # per axis, inside the arena
    dt: Annotated[float, Meta(gt=0, le=1)] = 0.1  # step of wind and plume, s


class Plume(Table, frozen=True):
    """The filaments (1.1), (1.4), (1.5)."""

    release_rate: Annotated[float, Meta(ge=0, le=1000)] = 10.0  # filaments/s, Poisson; 0: there is no source to find
    radius: Positive = 0.5  # R(0), m
    growth: Literal["farrell1", "printed", "farrell2"] = "farrell1"
    growth_rate: NonNegative = 0.001  # gamma (Table 1.1)
    dispersion: NonNegative = 0.03  # sigma, m/sqrt(s): white noise v_i of (1.1)
    amount: Positive = 5123.7618  # Q per filament (Table 1.1)
    warm_up: Annotated[float, Meta(ge=0, le=3600)] = 300.0  # how long the source released before t = 0, s
    margin: NonNegative = 5.0  # a filament this far outside the arena has left, m


class Sensors(Table, frozen=True):
    """What the robots sense, and how well."""

    period: Annotated[float, Meta(gt=0, le=60)] = 1.0  # wind and gas sensors, s (Table 3.1: sampling time)
    wind_noise: NonNegative = 0.0  # standard deviation per axis, m/s
    position_noise: NonNegative = 0.0  # of the odometry, m per axis
    heading_noise: NonNegative = 0.0  # rad
    concentration_noise: NonNegative = 0.0  # relative standard deviation
    wind_history: Annotated[float, Meta(ge=0, le=600)] = 100.0  # wind recorded before the start, s at 1 Hz
    proximity: Annotated[float, Meta(ge=0, le=100)] | None = None  # other robots are sensed so far, m; 0: they are not,
    # as in the thesis; not given: as the algorithm's own table says (`plume_map.proximity`), and 0 without such a value


class Body(Table, frozen=True):
    """The P3-DX (Table 1.2; limits of Table 3.2)."""

    mass: Positive = 9.0  # m_i, kg
    hand: Positive = 0.12  # L_i, m
    inertia: Positive = 0.2  # J_i, kg m^2
    wheel_radius: Positive = 0.079  # b, m
    axle: Positive = 0.381  # l, m
    wheel_inertia: Positive = 0.07  # J_wheel, kg m^2
    max_torque: Positive = 0.8  # N m per wheel
    max_speed: Positive = 0.8  # |nu|, m/s
    max_turn: Positive = 1.57  # |omega|, rad/s
    saturation: Literal["per-wheel", "proportional"] = "per-wheel"


class Start(Table, frozen=True):
    """Where the robots stand at t = 0: a column from (x, y) upwards, heading +y, at rest."""

    x: Real = 95.0
    y: Real = -48.0
    spacing: Annotated[float, Meta(ge=0.4, le=50)] = 3.0  # m
    heading: Real = 1.5707963267948966  # rad
    positions: tuple[Point, ...] = ()  # instead of the column, one point per robot
    headings: tuple[Real, ...] = ()  # instead of `heading`, one per robot, rad


class Timing(Table, frozen=True):
    """The clocks."""

    tick: Annotated[float, Meta(gt=0, le=1)] = 0.05  # control period, s
    substep: Annotated[float, Meta(gt=0, le=1)] = 0.01  # physics, s
    decision: Annotated[float, Meta(gt=0, le=60)] = 1.0  # decision period, s (Table 3.1)
    stale_after: Positive = 0.5  # a neighbour's state older than this is left out of every sum, s
    listen: Positive = 1.0  # a robot that joins late waits at most so long for neighbours before it begins alone, s


class Search(Table, frozen=True):
    """Before the first detection."""

    target: Point = (80.0, 50.0)  # the group sweeps towards it, m
    speed: Positive = 0.8  # m/s
    after: Literal["sweep", "stay"] = "sweep"  # when the target is reached: lawn-mower legs upwind, or stand
    leg_spacing: Positive = 12.0  # between legs, m upwind


class Decision(Table, frozen=True):
    """The distributed decision algorithm, chapter 3, Algorithm 1."""

    threshold: NonNegative = 600.0  # a concentration above it is a detection, ppt
    memory: Annotated[int, Meta(ge=1, le=2000)] = 100  # wind samples kept (Algorithm 1: 100 s)
    gate: Literal["area", "printed", "estimate"] = "area"  # which displacements count as possible
    gate_size: Positive = 40.0  # alpha, m (Table 3.1), for the gates "printed" and "estimate"
    noise: Literal["model", "printed"] = "model"  # R(k) by (3.9), or the recursion printed in Algorithm 1
    sigma2: Positive = 2.1  # sigma^2, m^2 (Example 1)
    initial_variance: Positive = 1000.0  # P(0), m^2 (Example 1)
    process_noise: NonNegative = 20.0  # q per decision, m^2; 0 in the thesis
    recall: NonNegative = 20.0  # x_l, x_g (2.3) are the best of the latest so many seconds; 0: of all, as printed
    c1: Fraction = 0.8  # weight of the wind estimate in (3.31), Table 3.1; c_2 = 1 - c_1
    lost_after: Positive = 20.0  # no detection in the group for this long: lost, s
    lost: Literal["smell", "keep"] = "smell"  # then h^ic is where the odour was met last, or stays as printed


class Fusion(Table, frozen=True):
    """The consensus fusion (3.26)."""

    beta: NonNegative = 8.0  # Table 3.1
    lam: NonNegative = 0.8  # lambda
    a: OpenFraction = 0.5
    input: Literal["measured", "always"] = "measured"  # lambda only for robots that measured now, or for all
    step: Literal["implicit", "explicit"] = "implicit"  # discretisation, see robot_agent.sig
    kind: Literal["plain", "resilient"] = "plain"  # as (3.26) says, or so that `liars` neighbours cannot pull it away
    filter: Literal["trimmed", "median"] = "trimmed"  # how, see robot_agent.resilient
    liars: Annotated[int, Meta(ge=0, le=1000)] = 1  # F: so many of a robot's neighbours may lie
    judge: Literal["words", "states"] = "words"  # resilient: the input by robot_agent.words, or as with "plain"
    hold: Positive = 20.0  # a word counts for so long after its robot measured, s
    lone: Literal["follow", "wait"] = "follow"  # what a robot without a word makes of no more than `liars` of them


class Planning(Table, frozen=True):
    """The movement plan (3.32)."""

    slope_limit: NonNegative = 1.0  # bound on |w_y / w_x|; 0: none
    slope: Literal["magnitude", "printed"] = "magnitude"  # |w_y| / |w_x|, or |w_y| / w_x as printed
    speed: Positive = 0.8  # |v_c|, m/s
    lost: Literal["circle", "rest"] = "circle"  # without a plume the plan circles about h^ic, or is h^ic as printed
    circle: Positive = 10.0  # radius of the last robot's circle, m; robot i's is i/N of it
    turn: Positive = 0.06  # rad/s
    passed: Literal["upwind", "back"] = "upwind"  # where v_c points when the robot is upwind of its target already


class Control(Table, frozen=True):
    """What all control laws have in common."""

    step: Literal["implicit", "explicit"] = "implicit"  # sampled-data form of sig(.)^a, see robot_agent.sig
    relay: bool = True  # neighbours pass on whom they have heard, so that all keep clear of all
    relay_period: Positive = 0.2  # s
    relay_age: Positive = 2.0  # older states are not passed on, s
    foresee: bool = True  # neighbours count where they are by now, not where a late state was told
    remember: NonNegative = 600.0  # who fell silent is kept clear of where it was last for so long, s; 0: forgotten


class Declaration(Table, frozen=True):
    """When the swarm says that it has found the source, without being told; not of the thesis."""

    stop: Literal["reached", "declared"] = "reached"  # what ends the run: a robot at the source, or the swarm's own word
    radius: Positive = 0.45  # a robot is sure when its posterior is this narrow, m
    hold: NonNegative = 5.0  # and has been for so long, s
    meetings: Annotated[int, Meta(ge=0, le=20)] = 2  # and the odour was met again there so often, once of them since then,
    recall: Positive = 60.0  # all of them within so long, s
    tolerance: Positive = 0.5  # estimates so near to each other agree, m
    window: Positive = 10.0  # a robot not heard of for so long is not asked, s
    period: Positive = 0.2  # between two tellings of the votes, s


class Network(Table, frozen=True):
    """The wires."""

    transport: Literal["auto", "unix", "tcp"] = "auto"
    port: Annotated[int, Meta(ge=0, le=65000)] = 0  # first TCP port; 0: free ones
    endpoints: tuple[str, ...] = ()  # world's first, then each robot's; empty: made by the launcher
    lease_ms: Annotated[int, Meta(ge=100, le=60000)] = 2000  # a silent link is dead after this
    join_timeout: Positive = 30.0  # wall-clock s for the swarm to link up
    return_timeout: Positive = 10.0  # wall-clock s that the world waits for a robot that is due back from a hang


class Recording(Table, frozen=True):
    """What the recorder is told; it changes nothing of the run."""

    truth_period: Positive = 0.1  # between two states of the robots, simulated s
    field_period: Positive = 0.5  # between two pictures of plume and wind, simulated s
