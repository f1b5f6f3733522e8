"""A detection event: what one robot met at one decision, and the way that the air had come.

Rules: an event is complete in itself. The robot that made it traced the air back by the wind that it measured itself, and
says where the air was so many seconds before. Whoever hears the event needs no wind history of anybody to use it, and makes
the same of it as everybody else, whenever it comes. The robot that made it uses what the others will read, too: the
quantised record, never the numbers behind it.

The record, 14 bytes: robot (u16), then 96 bits from the low ones on: x and y (12 bits each, parts of the arena), hit (1),
diffusivity (7), the mean wind of the first stretch of the way (2 x 8), and where each of the 6 other stretches ends (2 x 4),
told as how far that is from where the mean wind since then leads, in steps that widen with the way's own deviation
    sigma(q)^2 = sigma_0^2 + D q.
Where a way bends more sharply than the steps can say, it is caught up with at the next stretch: rounding never adds up.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from math import isfinite, log, sqrt
from typing import NamedTuple

from protocol.scenario.sections import Arena

LAGS = (2.0, 5.0, 11.0, 22.0, 40.0, 68.0, 110.0)  # s: ends of the stretches; further back the way is less certain
SIZE = 14  # bytes of a record
NAME = 2  # of them say whose it is
_PLACES, _INSIDE = 4096, 3072  # steps of a coordinate; of them inside the arena: a robot may stand a little outside
_D0, _RATIO, _CODES = 0.01, 1.06, 128  # diffusivity: _D0 _RATIO^code, m^2/s
_SIGMA0 = 0.7  # m


def _ladder(first: float, ratio: float, count: int) -> tuple[float, ...]:
    """0 and `count` rungs, the first two `first` apart, every distance `ratio` times the one before."""
    rungs, step = [0.0], first
    for _ in range(count):
        rungs.append(rungs[-1] + step)
        step *= ratio
    return tuple(rungs)


_WIND = _ladder(0.01, 1.04, 128)  # m/s: 1 cm/s apart in a calm, 5 cm/s at 1 m/s; the last is 37 m/s
_BEND = _ladder(0.2, 1.25, 8)  # deviations of the way: 0.2 apart at first; the last is 4
_SPANS = tuple((m, lag, LAGS[m + 1], (LAGS[m + 1] - lag) / lag) for m, lag in enumerate(LAGS[:-1]))


def _signed(rungs: tuple[float, ...]) -> tuple[float, ...]:
    """By code: 0 ... n - 1 as they are, n ... 2 n - 1 for -n ... -1."""
    return rungs[:-1] + tuple(-rung for rung in reversed(rungs[1:]))


_WINDS, _BENDS = _signed(_WIND), _signed(_BEND)
_DS = tuple(_D0 * _RATIO**code for code in range(_CODES))
_SIGMAS = tuple(tuple(sqrt(_SIGMA0 * _SIGMA0 + D * lag) for lag in LAGS[1:]) for D in _DS)

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
    code = _clip(round(log(max(D, _D0) / _D0) / log(_RATIO)), 0, _CODES - 1) if isfinite(D) else _CODES - 1
    u = _place(x, arena.x_min, arena.x_max)
    v = _place(y, arena.y_min, arena.y_max)
    bits = u | v << 12 | hit << 24 | code << 25
    c, d = _nearest(_WIND, way[0][0] / LAGS[0]), _nearest(_WIND, way[0][1] / LAGS[0])
    bits |= c << 32 | d << 40
    ax, ay = _WINDS[c] * LAGS[0], _WINDS[d] * LAGS[0]  # where the reader will have come to
    shift = 48
    for (bx, by), sigma, (_, _, _, part) in zip(way[1:], _SIGMAS[code], _SPANS, strict=True):
        ax, ay = ax + ax * part, ay + ay * part
        c, d = _nearest(_BEND, (bx - ax) / sigma), _nearest(_BEND, (by - ay) / sigma)
        ax, ay = ax + _BENDS[c] * sigma, ay + _BENDS[d] * sigma
        bits |= (c | d << 4) << shift
        shift += 8
    return robot.to_bytes(NAME, "little") + bits.to_bytes(SIZE - NAME, "little")


def unpack(record: bytes, arena: Arena) -> Event:
    """Read a record of `SIZE` bytes; any bytes are some event."""
    bits = int.from_bytes(record[NAME:8], "little")
    x = arena.x_min + ((bits & 4095) - 512) / _INSIDE * (arena.x_max - arena.x_min)
    y = arena.y_min + ((bits >> 12 & 4095) - 512) / _INSIDE * (arena.y_max - arena.y_min)
    code = bits >> 25 & 127
    ax, ay = _WINDS[bits >> 32 & 255] * LAGS[0], _WINDS[bits >> 40] * LAGS[0]
    way = [(0.0, x, y), (LAGS[0], x - ax, y - ay)]
    sigmas = _SIGMAS[code]
    for m, _, lag, part in _SPANS:
        both, sigma = record[8 + m], sigmas[m]
        ax, ay = ax + ax * part + _BENDS[both & 15] * sigma, ay + ay * part + _BENDS[both >> 4] * sigma
        way.append((lag, x - ax, y - ay))
    return Event(int.from_bytes(record[:NAME], "little"), bool(bits >> 24 & 1), x, y, _DS[code], tuple(way))


def robot_of(record: bytes) -> int:
    return int.from_bytes(record[:NAME], "little")


def _place(x: float, low: float, high: float) -> int:
    return _clip(round((x - low) / (high - low) * _INSIDE) + 512, 0, _PLACES - 1)


def _nearest(rungs: tuple[float, ...], value: float) -> int:
    """Code of the rung that is nearest to `value`."""
    size = abs(value)
    n = bisect_right(rungs, size)
    if n == len(rungs) or (n > 0 and size - rungs[n - 1] <= rungs[n] - size):
        n -= 1
    last = len(rungs) - 1
    return min(n, last - 1) if value >= 0.0 else (2 * last - n) % (2 * last)


def _clip(n: int, low: int, high: int) -> int:
    return low if n < low else high if n > high else n
