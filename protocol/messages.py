"""What is said: frozen records, SI units and radians, positions in the arena's frame.

Rules: a message holds plain numbers, strings, bytes and tuples; every float is finite; a message never changes after it
was made, so that it can be handed on by reference in memory and by bytes over the wire with the same result.
"Hand" is the point L ahead of the wheel axis that the thesis steers, (1.8); "centre" is the middle of the axis.
"""

from __future__ import annotations

from msgspec import Struct

NEVER = -1.0  # a time that has not come yet


class Message(Struct, frozen=True, array_like=True, gc=False):
    """Base of everything that travels."""


class Reading(Message, frozen=True, array_like=True, gc=False):
    """World to robot, every tick: what robot `robot` senses at tick `tick`."""

    robot: int
    tick: int
    t: float  # simulated time, s
    x: float  # centre position r, m
    y: float
    theta: float  # heading, rad
    nu: float  # forward speed, m/s
    omega: float  # turn rate, rad/s
    wind_x: float  # local wind, m/s
    wind_y: float
    concentration: float  # ppt
    hears: tuple[tuple[int, int], ...] = ()  # lock-step: the (neighbour, tick) states to wait for
    wind_past: tuple[tuple[float, float], ...] = ()  # tick 0 only: wind recorded before the start, oldest first


class Shared(Message, frozen=True, array_like=True, gc=False):
    """Robot to its neighbours, every tick: all that one robot ever tells another."""

    robot: int
    tick: int
    x: float  # hand position x_i, m
    y: float
    vx: float  # hand velocity v_i, m/s
    vy: float
    fusion_x: float  # state of the fusion (3.26), m; meaningless until detected_at >= 0
    fusion_y: float
    first_detected_at: float  # when anyone first detected, as far as I heard, s; NEVER
    detected_at: float  # when anyone last detected, as far as I heard, s; NEVER
    best_concentration: float  # highest concentration that anyone met, as far as I heard, ppt
    best_x: float  # and where, m
    best_y: float
    search_leg: int  # crosswind search: leg number, who set its heading, the heading as a unit vector
    search_by: int
    search_x: float
    search_y: float
    h_x: float  # my decision h^ic (3.31), m
    h_y: float
    relayed: tuple[tuple[int, int, float, float, float, float], ...] = ()  # passed on: (robot, tick, x, y, vx, vy)
    virtual: tuple[float, ...] = ()  # an algorithm's own numbers (virtual position and velocity, charge, ...)


class Drive(Message, frozen=True, array_like=True, gc=False):
    """Robot to world, every tick: wheel torques (1.11), (1.12), N m."""

    robot: int
    tick: int
    tau_left: float
    tau_right: float


class Report(Message, frozen=True, array_like=True, gc=False):
    """Robot to world, once, after `Halt`: final decision and what went over its wires."""

    robot: int
    h_x: float
    h_y: float
    has_estimate: bool
    sent: int
    received: int
    dropped: int  # came too late, twice, or too many to keep
    refused: int  # malformed, foreign, from the wrong sender


class Halt(Message, frozen=True, array_like=True, gc=False):
    """World to everyone: the run is over."""

    tick: int
    reason: str


class Belief(Message, frozen=True, array_like=True, gc=False):
    """Robot to recorder, at every decision: what it thinks. Best effort."""

    robot: int
    tick: int
    t: float
    mode: str  # "search" | "trace" | "lost" | ...
    has_estimate: bool
    h_x: float  # decision h^ic, m
    h_y: float
    x_hat_x: float  # Kalman estimate, m
    x_hat_y: float
    variance: float  # P, m^2 per axis
    fusion_x: float
    fusion_y: float
    target_x: float  # planned target p_i, m
    target_y: float
    detected_at: float
    heard: tuple[int, ...]  # neighbours whose state this decision used
    links: tuple[int, ...]  # robots that are physically linked to me now
    dropped: int
    refused: int


class Truth(Message, frozen=True, array_like=True, gc=False):
    """World to recorder: the robots as they are. Best effort."""

    tick: int
    t: float
    count: int  # running number of truth messages, so that gaps can be told
    robots: bytes  # float64 little-endian, shape (N, 9): x, y, theta, nu, omega, tau_left, tau_right, ppt, alive


class Field(Message, frozen=True, array_like=True, gc=False):
    """World to recorder: plume and wind as they are. Best effort."""

    tick: int
    t: float
    filaments: bytes  # float32 little-endian, shape (M, 3): x, y, radius
    wind: bytes  # float32 little-endian, shape (nx, ny, 2): velocity at the nodes of the arena


class Event(Message, frozen=True, array_like=True, gc=False):
    """World to recorder and launcher: something a person wants to know."""

    tick: int
    t: float
    robot: int  # -1: the world or the whole swarm
    text: str


class Progress(Message, frozen=True, array_like=True, gc=False):
    """World to launcher, some ten times a second of wall clock."""

    tick: int
    t: float
    live: int
    detections: int
    closest: float  # smallest distance of a robot to the source so far, m


class Outcome(Message, frozen=True, array_like=True, gc=False):
    """World to launcher: how the run ended; the keys of `odourswarm run --json`."""

    found: bool
    time: float  # simulated s at the end of the run
    finder: int  # -1: nobody
    ticks: int
    wall_s: float
    ticks_per_s: float
    digest: str
    distance_travelled: tuple[float, ...]  # m, per robot
    estimate_error: tuple[float | None, ...]  # m, per robot, at the end; None: it has no estimate
    min_pair_distance: float | None  # m; None with one robot
    run: str
    seed: int
    scenario_digest: str
    faults: tuple[str, ...]  # what was injected and seen
    messages: dict[str, int]  # sent, received, dropped, refused
    ended: str  # "found" | "time out" | "interrupted" | a failure, as a sentence
    failed: bool  # processes failed beyond what the scenario planned
    first_detection: float | None  # s


class Ask(Message, frozen=True, array_like=True, gc=False):
    """Query to the world: the scenario, please. `robot` is -1 for the recorder and the launcher."""

    robot: int


class Join(Message, frozen=True, array_like=True, gc=False):
    """Query to the world: my declared links are up."""

    robot: int
    links: tuple[int, ...]


class Answer(Message, frozen=True, array_like=True, gc=False):
    """Reply to a query: `text` is JSON when `ok`, otherwise the sentence that says why not."""

    ok: bool
    text: str
