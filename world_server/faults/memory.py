"""What the faults of the world remember from tick to tick, as bytes for a snapshot."""

from __future__ import annotations

import msgspec
from msgspec import Struct

from world_server.faults.sensor import SensorFaults
from world_server.radio import Radio


class _Memory(Struct, array_like=True):
    since: dict[int, int]
    rows: dict[int, dict[int, tuple[int, ...]]]
    held: dict[int, tuple[float, ...]]


def remember(radio: Radio, sensors: SensorFaults) -> bytes:
    """What radio and sensors remember."""
    rows = radio.channel.rows if radio.channel is not None else {}
    return msgspec.msgpack.encode(_Memory(radio.since, rows, sensors.held))


def recall(memory: bytes, radio: Radio, sensors: SensorFaults) -> None:
    """Give radio and sensors of the same scenario what they remembered; nothing when `memory` is empty."""
    if memory:
        kept = msgspec.msgpack.decode(memory, type=_Memory)
        radio.since.update(kept.since)
        if radio.channel is not None:
            radio.channel.rows.update(kept.rows)
        sensors.held = kept.held
