"""What is said: frozen records, SI units and radians, positions in the arena's frame.

Rules: a message holds plain numbers, strings, bytes and tuples; every float is finite; a message never changes after it
was made, so that it can be handed on by reference in memory and by bytes over the wire with the same result.
"Hand" is the point L ahead of the wheel axis that the thesis steers, (1.8); "centre" is the middle of the axis.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta, Struct

# The bounds are checked by the decoder; they also keep out what is not finite. Nothing we say in SI units comes near.
Number = Annotated[float, Meta(ge=-1e12, le=1e12)]
MAX_RECORDS = 4096  # entries of one tuple
MAX_EVENTS = 1 << 16  # bytes
RECORDS = Meta(max_length=MAX_RECORDS)
VoteRecord = tuple[int, Number, Number, Number, Number]  # robot, its time (s), x, y, radius of its posterior (m)
DeclaredRecord = tuple[Number, int, Number, Number]  # when (s), by whom, x, y: the source is there
RelayedState = tuple[int, int, Number, Number, Number, Number]  # robot, tick, x, y, vx, vy

NEVER = -1.0  # a time that has not come yet


class Message(Struct, frozen=True, array_like=True, gc=False):
    """Base of everything that travels."""


class Reading(Message, frozen=True, array_like=True, gc=False):
    """World to robot, every tick: what robot `robot` senses at tick `tick`."""

    robot: int
    tick: int
    t: Number  # simulated time, s
    x: Number  # centre position r, m
    y: Number
    theta: Number  # heading, rad
    nu: Number  # forward speed, m/s
    omega: Number  # turn rate, rad/s
    wind_x: Number  # local wind, m/s
    wind_y: Number
    concentration: Number  # ppt
    hears: Annotated[tuple[tuple[int, int], ...], RECORDS] = ()  # lock-step: the (neighbour, tick) states to wait for
    wind_past: Annotated[tuple[tuple[Number, Number], ...], RECORDS] = ()  # tick 0: wind before the start, oldest first
    slip: Number = 0.0  # real time: by how much the world's schedule has moved on the wall clock, s
    near: Annotated[tuple[tuple[Number, Number], ...], RECORDS] = ()  # hands within `sensors.proximity`, nearest first:
    # how far ahead of the own hand and how far to its left, m. Whose they are is not sensed


class Shared(Message, frozen=True, array_like=True, gc=False):
    """Robot to its neighbours, every tick: all that one robot ever tells another."""

    robot: int
    tick: int
    x: Number  # hand position x_i, m
    y: Number
    vx: Number  # hand velocity v_i, m/s
    vy: Number
    fusion_x: Number  # state of the fusion (3.26), m; meaningless until detected_at >= 0
    fusion_y: Number
    first_detected_at: Number  # when anyone first detected, as far as I heard, s; NEVER
    detected_at: Number  # when anyone last detected, as far as I heard, s; NEVER
    best_concentration: Number  # highest concentration that anyone met, as far as I heard, ppt
    best_x: Number  # and where, m
    best_y: Number
    search_leg: int  # crosswind search: leg number, who set its heading, the heading as a unit vector
    search_by: int
    search_x: Number
    search_y: Number
    h_x: Number  # my decision h^ic (3.31), m
    h_y: Number
    relayed: Annotated[tuple[RelayedState, ...], RECORDS] = ()  # states of others, passed on
    virtual: Annotated[tuple[Number, ...], RECORDS] = ()  # a controller's own numbers, e.g. a virtual position
    notes: Annotated[tuple[Number, ...], RECORDS] = ()  # a decision's own numbers, e.g. what it remembers to have smelt
    best_at: Number = NEVER  # when the highest concentration was met, s
    events: Annotated[bytes, Meta(max_length=MAX_EVENTS)] = b""  # a decision's own bytes, e.g. flooded detection events
    votes: Annotated[tuple[VoteRecord, ...], RECORDS] = ()  # what each robot holds the source's place for, passed on
    declared: DeclaredRecord | None = None  # the source is found, as the swarm says
    word: tuple[Number, Number, Number] | None = None  # resilient fusion: my own x_hat_i, m, and when I measured last, s


class Drive(Message, frozen=True, array_like=True, gc=False):
    """Robot to world, every tick: wheel torques (1.11), (1.12), N m."""

    robot: int
    tick: int
    tau_left: Number
    tau_right: Number
    declared: DeclaredRecord | None = None  # the source is found, as the swarm says


class Report(Message, frozen=True, array_like=True, gc=False):
    """Robot to world, once, after `Halt`: final decision and what went over its wires."""

    robot: int
    h_x: Number
    h_y: Number
    has_estimate: bool
    sent: int
    received: int
    dropped: int  # came too late, twice, or too many to keep
    refused: int  # malformed, foreign, from the wrong sender


class Resume(Message, frozen=True, array_like=True, gc=False):
    """World to a robot that does not take part at present: your next reading is that of tick `tick`; answer `Linked`."""

    robot: int
    tick: int


class Linked(Message, frozen=True, array_like=True, gc=False):
    """Robot to world: who of my neighbours is linked to me now. In answer to `Resume`, and whenever it changes."""

    robot: int
    tick: int  # of the `Resume` that this answers; -1: none
    links: tuple[int, ...]


class Inject(Message, frozen=True, array_like=True, gc=False):
    """World to launcher: a planned fault of a robot's process is due."""

    robot: int
    tick: int
    action: str  # "stop" (SIGSTOP) | "continue" (SIGCONT) | "kill" (SIGKILL)


class Halt(Message, frozen=True, array_like=True, gc=False):
    """World to everyone: the run is over."""

    tick: int
    reason: str


class Belief(Message, frozen=True, array_like=True, gc=False):
    """Robot to recorder, at every decision: what it thinks. Best effort."""

    robot: int
    tick: int
    t: Number
    mode: str  # "search" | "trace" | "lost" | ...
    has_estimate: bool
    h_x: Number  # decision h^ic, m
    h_y: Number
    x_hat_x: Number  # Kalman estimate, m
    x_hat_y: Number
    variance: Number  # P, m^2 per axis
    fusion_x: Number
    fusion_y: Number
    target_x: Number  # planned target p_i, m
    target_y: Number
    detected_at: Number
    heard: tuple[int, ...]  # neighbours whose state this decision used
    links: tuple[int, ...]  # robots that are physically linked to me now
    dropped: int
    refused: int


class Stopped(Message, frozen=True, array_like=True, gc=False):
    """Launcher to world, which passes it on to its robots: a robot's process stands still, or goes on again."""

    robot: int
    stopped: bool


class BeliefMap(Message, frozen=True, array_like=True, gc=False):
    """Robot to recorder, every few seconds: how probable it holds each place for the source's. Best effort."""

    robot: int
    tick: int
    t: Number
    x: Number  # lower corner of the map, m
    y: Number
    cell: Number  # side of a cell, m
    rows: int
    levels: bytes  # zlib of a byte per cell, row by row towards +y: 255 sqrt(p / p_max), see `robot_agent.interfaces`


class Truth(Message, frozen=True, array_like=True, gc=False):
    """World to recorder: the robots as they are. Best effort."""

    tick: int
    t: Number
    count: int  # running number of truth messages, so that gaps can be told
    robots: bytes  # float64 little-endian, shape (N, 9): x, y, theta, nu, omega, tau_left, tau_right, ppt, alive


class Field(Message, frozen=True, array_like=True, gc=False):
    """World to recorder: plume and wind as they are. Best effort."""

    tick: int
    t: Number
    filaments: bytes  # float32 little-endian, shape (M, 3): x, y, radius
    wind: bytes  # float32 little-endian, shape (nx, ny, 2): velocity at the nodes of the arena


class Event(Message, frozen=True, array_like=True, gc=False):
    """World to recorder and launcher: something a person wants to know."""

    tick: int
    t: Number
    robot: int  # -1: the world or the whole swarm
    text: str


class Progress(Message, frozen=True, array_like=True, gc=False):
    """World to launcher, some ten times a second of wall clock."""

    tick: int
    t: Number
    live: int
    detections: int
    closest: Number  # distance of the robot that is nearest to the source, m


class Outcome(Message, frozen=True, array_like=True, gc=False):
    """World to launcher: how the run ended; the keys of `odourswarm run --json`."""

    found: bool
    time: Number  # simulated s at the end of the run
    finder: int  # -1: nobody
    ticks: int
    wall_s: Number
    ticks_per_s: Number
    digest: str
    distance_travelled: tuple[Number, ...]  # m, per robot
    estimate_error: tuple[Number | None, ...]  # m, per robot, at the end; None: it has no estimate
    min_pair_distance: Number | None  # m; None with one robot
    run: str
    seed: int
    scenario_digest: str
    faults: tuple[str, ...]  # what was injected and seen
    messages: dict[str, int]  # sent, received, dropped, refused
    ended: str  # "found" | "time out" | "interrupted" | a failure, as a sentence
    failed: bool  # processes failed beyond what the scenario planned
    first_detection: Number | None  # s
    clock: str = "lockstep"  # or "realtime": such a run does not repeat, its digest only names it
    missed: tuple[int, ...] = ()  # real time: control periods without an answer, per robot
    behind: Number = 0.0  # real time: furthest that the world was behind the wall clock, s
    slip: Number = 0.0  # real time: by how much it gave up to catch up, s
    disagreement: Number | None = None  # m: largest distance of two robots' estimates at the end; None: fewer than two
    declared: bool = False  # every live robot told one and the same place of the source
    declared_at: Number | None = None  # when all of them did, s
    declared_by: int = -1  # who said it first; -1: nobody
    declared_x: Number | None = None  # and where, m
    declared_y: Number | None = None
    declaration_error: Number | None = None  # how far that is from the source, m
    reached_at: Number | None = None  # when a robot reached the source (`found`), s
    declaration_delay: Number | None = None  # from reaching to declaring, s; negative: declared before
    false_declaration: bool = False  # declared further than 2 m off, or where there is no source


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
