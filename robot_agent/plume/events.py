"""A detection event: what one robot met at one decision, and the way that the air had come.

Rules: an event is complete in itself. The robot that made it traced the air back by the wind that it measured itself, and
says where the air was so many seconds before. Whoever hears the event needs no wind history of anybody to use it, and makes
the same of it as everybody else, whenever it comes. The robot that made it uses what the others will read, too: the
quantised record, never the numbers behind it.

The record, 23 bytes: robot (u16), age (u8, decisions before the message's), x and y (u16, parts of the arena), hit and
diffusivity (1 + 7 bits), unit of the speeds (u8), and for each of 7 stretches of the way the mean wind (2 i8).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, isfinite, log
from struct import Struct
from typing import NamedTuple

from protocol.scenario.sections import Arena

LAGS = (2.0, 5.0, 11.0, 22.0, 40.0, 68.0, 110.0)  # s: ends of the stretches; further back the way is less certain
_FORM = Struct(f"<HHHBB{2 * len(LAGS)}b")
SIZE = _FORM.size  # bytes of a record without its age
UNIT = 0.005  # m/s
_D0, _RATIO = 0.01, 1.06  # diffusivity: _D0 _RATIO^code, m^2/s

Key = tuple[int, int]  # (decision, robot)
Place = tuple[float, float]


class Event(NamedTuple):
    """One record, read."""

    robot: int
    hit: bool
    x: float  # where it was sensed, m
    y: float
    D: float  # growth of the way's variance, m^2/s
    way: tuple[tuple[float, float, float], ...]  # (lag s, x, y m), from lag 0 on


def pack(robot: int, hit: bool, x: float, y: float, D: float, way: Sequence[Place], arena: Arena) -> bytes:
    """The record of an event.

    Args:
        x, y: where it was sensed, m.
        D: m^2/s.
        way: displacement of the air during the latest LAGS[m] seconds, m; one for every lag.
    """
    places = [(0.0, 0.0), *way]
    lags = (0.0, *LAGS)
    fastest = 0.0
    for m in range(len(LAGS)):
        (ax, ay), (bx, by), span = places[m], places[m + 1], lags[m + 1] - lags[m]
        fastest = max(fastest, abs(bx - ax) / span, abs(by - ay) / span)
    scale = min(256, max(1, ceil(1.1 * fastest / (127 * UNIT)))) if isfinite(fastest) else 256
    speeds: list[int] = []
    ax = ay = 0.0  # what the reader will have come to: rounding does not add up
    for (bx, by), lag, before in zip(way, LAGS, lags, strict=False):
        step = (lag - before) * scale * UNIT
        p, q = _clip(round((bx - ax) / step), -127, 127), _clip(round((by - ay) / step), -127, 127)
        ax, ay = ax + p * step, ay + q * step
        speeds += (p, q)
    code = _clip(round(log(max(D, _D0) / _D0) / log(_RATIO)), 0, 127)
    u = _clip(round((x - arena.x_min) / (arena.x_max - arena.x_min) * 49152) + 8192, 0, 65535)
    v = _clip(round((y - arena.y_min) / (arena.y_max - arena.y_min) * 49152) + 8192, 0, 65535)
    return _FORM.pack(robot, u, v, code << 1 | hit, scale - 1, *speeds)


def unpack(record: bytes, arena: Arena) -> Event:
    """Read a record of `SIZE` bytes; any bytes are some event."""
    robot, u, v, flags, scale, *speeds = _FORM.unpack(record)
    # A quarter of the numbers lies outside the arena: a robot may stand a little outside.
    x = arena.x_min + (u - 8192) / 49152 * (arena.x_max - arena.x_min)
    y = arena.y_min + (v - 8192) / 49152 * (arena.y_max - arena.y_min)
    way = [(0.0, x, y)]
    bx, by, before = x, y, 0.0
    for m, lag in enumerate(LAGS):
        step = (lag - before) * (scale + 1) * UNIT
        bx, by, before = bx - speeds[2 * m] * step, by - speeds[2 * m + 1] * step, lag
        way.append((lag, bx, by))
    return Event(robot, bool(flags & 1), x, y, _D0 * _RATIO ** (flags >> 1), tuple(way))


def robot_of(record: bytes) -> int:
    return int.from_bytes(record[:2], "little")


def _clip(n: int, low: int, high: int) -> int:
    return low if n < low else high if n > high else n
