"""The whole truth at one tick as bytes: what a world needs to go on as if it had never stopped.

Rules: no pickle; msgpack arrays with a schema version in front. Everything that decides the future is in it and nothing
else: draws are addressed, so that no generator has a state to keep; what follows from the scenario is made again from it.
Arrays keep their bits and their order, for sums of floats depend on it.
"""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from protocol.errors import SwarmFailure

VERSION = 1

Array = NDArray[np.float64]


class AirState(Struct, frozen=True, array_like=True):
    """Wind and plume."""

    step: int  # of the field, from the start of the warm-up
    wind_step: int
    flow: bytes  # (2, m*m), m/s
    corners: bytes  # (2, 8): the coloured noise and its slope
    plume_step: int
    released: int
    left: int
    room: int  # columns of the plume's arrays
    places: bytes  # (2, alive), m
    births: bytes  # (alive,), s


class BodyState(Struct, frozen=True, array_like=True):
    """One robot's body."""

    x: float
    y: float
    theta: float
    nu: float
    omega: float
    travelled: float
    hand_x: float
    hand_y: float
    braking: bool


class VerdictState(Struct, frozen=True, array_like=True):
    """Who found the source, and the closest pair so far. Slacks may be infinite, so all floats are bytes."""

    found: tuple[int, float] | None
    numbers: bytes  # pair2, source_slack, pair_slack


class WorldState(Struct, frozen=True, array_like=True):
    """A `World` at one tick."""

    version: int
    tick: int
    live: tuple[int, ...]
    air: AirState
    bodies: tuple[BodyState, ...]
    verdict: VerdictState
    first_detection: float | None
    first_detector: int
    detections: int
    torques: tuple[tuple[float, ...], tuple[float, ...]]
    concentration: tuple[float, ...]
    wind: tuple[tuple[float, ...], tuple[float, ...]]
    wind_past: bytes  # (S, N, 2), m/s; empty after tick 0, when everyone has been told
    chain: bytes  # digest of what was hashed so far
    history: bytes  # float64, to be hashed next
    faults: bytes = b""  # what faults remember (`world_server.faults`)


def pack(array: Any) -> bytes:
    """The float64 of `array`, bit for bit."""
    return np.ascontiguousarray(array, dtype="<f8").tobytes()


def unpack(data: bytes, *shape: int) -> Array:
    """What `pack` packed, in `shape`."""
    return np.frombuffer(data, dtype="<f8").astype(np.float64).reshape(shape)


def encode(state: WorldState) -> bytes:
    """The bytes of `state`."""
    return msgspec.msgpack.encode(state)


def decode(data: bytes) -> WorldState:
    """The state in `data`.

    Raises: SwarmFailure when it is none of this version.
    """
    try:
        version = msgspec.msgpack.decode(data)[0]
        if version == VERSION:
            return msgspec.msgpack.decode(data, type=WorldState)
    except (msgspec.MsgspecError, TypeError, IndexError, KeyError, ValueError):
        version = "unknown"
    raise SwarmFailure(f"the snapshot of the world is of version {version}; this world reads version {VERSION} only.")
