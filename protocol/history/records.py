"""What a member writes down: compact records, one after the other, in the order in which things happened to it.

Rules: a record is plain numbers and never changes; it is written before what it tells of leaves the member (a state that
a neighbour has heard stands in its sender's history, whenever the sender was killed). Ticks of states are kept as ages,
which are small: a state of tick k heard at tick n has the age n - k. Numbers may be NaN or infinite here: finding those is
what a history is for.
"""

from __future__ import annotations

from zlib import crc32

import msgspec
from msgspec import Struct, structs

from protocol.messages import Shared

VERSION = 1

Point = tuple[float, float]
Heard = tuple[int, int, int]  # robot, age, content
Used = tuple[int, int, float, Point | None]  # robot, age, a_ij, its fusion state as it was heard; None: it has none yet
Torques = tuple[int, float, float]  # robot, left, right, N m
Pose = tuple[float, float, float, float, float]  # x, y, theta, nu, omega of the centre of the axle
Hears = tuple[int, tuple[tuple[int, int], ...]]  # robot, the (neighbour, age) states that it may hear


class Begin(Struct, frozen=True, array_like=True, gc=False, tag=0):
    """A member begins, or begins again after it was started anew."""

    version: int
    run: str
    member: str
    scenario: bytes  # world: the whole scenario as JSON; robots: nothing
    fuses: bool  # robots: it has a Kalman filter and the fusion (3.26)


class Sent(Struct, frozen=True, array_like=True, gc=False, tag=1):
    """Robot: what it is about to tell its neighbours."""

    tick: int
    content: int  # of the whole state, see `content_of`
    x: float  # hand position x_i, m
    y: float
    fusion: Point  # y_i before the exchange of this tick, m
    begun: bool  # whether it knows of a detection: before, y_i means nothing


class Mind(Struct, frozen=True, array_like=True, gc=False):
    """Robot: what changes at decisions only."""

    mode: str
    P: float  # variance of its estimate, m^2 per axis
    input: Point | None  # u_i of the fusion: its estimate if it measured, m


class Acted(Struct, frozen=True, array_like=True, gc=False, tag=2):
    """Robot: what it heard and used, and the drive that it is about to send."""

    tick: int
    heard: tuple[Heard, ...]
    used: tuple[Used, ...]  # in the sums over the neighbours, after all that was left out
    fusion: Point | None  # y_i after the exchange, m; None: it has none yet
    mind: Mind | None  # None: as it was
    tau_left: float  # N m
    tau_right: float


class Moved(Struct, frozen=True, array_like=True, gc=False, tag=3):
    """World: the bodies at `tick`, and what moved them there from the tick before."""

    tick: int
    poses: tuple[Pose, ...]
    drives: tuple[Torques, ...]  # that were taken
    braked: tuple[int, ...]  # robots whose bodies ignored their drives
    dead: tuple[int, ...]  # robots that were lost
    ppt: tuple[float, ...] | None  # concentration at every hand; None: the sensors did not sample


class Told(Struct, frozen=True, array_like=True, gc=False, tag=4):
    """World: whose states each robot may hear at `tick`."""

    tick: int
    hears: tuple[Hears, ...]


class Verdict(Struct, frozen=True, array_like=True, gc=False, tag=5):
    """World: the run is over, and why."""

    tick: int
    reason: str


class Result(Struct, frozen=True, array_like=True, gc=False, tag=6):
    """World: the outcome."""

    found: bool
    finder: int  # -1: nobody
    time: float  # s
    ended: str
    digest: str


Record = Begin | Sent | Acted | Moved | Told | Verdict | Result

_encode = msgspec.msgpack.Encoder().encode


def content_of(shared: Shared) -> int:
    """32 bits that name the content of a state: the check sum of its wire form without its notes, which in real time a
    robot that missed them is given with the next state."""
    return crc32(_encode(structs.replace(shared, notes=()) if shared.notes else shared))
