"""The wire form: an 8-byte header and a msgpack array.

    byte 0-1  b"Os"
    byte 2    schema version
    byte 3    kind of message (its place in KINDS)
    byte 4-7  CRC-32 of bytes 0-3, the run's token and the body, little-endian
    byte 8-   msgpack array of the message's fields

Rules: no pickle; `decode` never raises on foreign bytes, it returns a `Refusal`; the check sum is started with the
run's token, so that another run's traffic and every truncated or mutated frame are refused. (The token tells friend
from stranger, it is not a secret: authentication is the business of TLS.)
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import msgspec

from protocol import messages as m

SCHEMA_VERSION = 1
MAX_FRAME = 1 << 20  # bytes

KINDS: tuple[type[m.Message], ...] = (
    m.Reading, m.Shared, m.Drive, m.Report, m.Halt, m.Belief, m.Truth, m.Field, m.Event, m.Progress, m.Outcome,
    m.Ask, m.Join, m.Answer, m.Resume, m.Linked, m.Inject, m.BeliefMap, m.Stopped,
)  # fmt: skip
_KIND_OF = {cls: kind for kind, cls in enumerate(KINDS)}
_PREFIX = {cls: b"Os" + bytes((SCHEMA_VERSION, kind)) for cls, kind in _KIND_OF.items()}
_DECODERS = tuple(msgspec.msgpack.Decoder(cls) for cls in KINDS)
_encode_body = msgspec.msgpack.Encoder().encode


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a frame was not taken."""

    reason: str


class Codec:
    """Encodes and decodes the messages of one run."""

    __slots__ = ("_seeds",)

    def __init__(self, token: int) -> None:
        salt = token.to_bytes(8, "little", signed=False)
        self._seeds = {prefix: zlib.crc32(salt, zlib.crc32(prefix)) for prefix in _PREFIX.values()}

    def encode(self, message: m.Message) -> bytes:
        """Frame `message`."""
        prefix = _PREFIX[type(message)]
        body = _encode_body(message)
        return b"".join((prefix, zlib.crc32(body, self._seeds[prefix]).to_bytes(4, "little"), body))

    def decode(self, frame: bytes) -> m.Message | Refusal:
        """Message in `frame`, or why it is refused; never raises."""
        if len(frame) < 9 or len(frame) > MAX_FRAME:
            return Refusal(f"a frame has 9 to {MAX_FRAME} bytes, this one has {len(frame)}")
        seed = self._seeds.get(frame[:4])
        if seed is None:
            return Refusal("unknown magic, schema version or kind")
        body = frame[8:]
        if zlib.crc32(body, seed) != int.from_bytes(frame[4:8], "little"):
            return Refusal("check sum differs: damaged, or of another run")
        try:
            return _DECODERS[frame[3]].decode(body)
        except (msgspec.DecodeError, ValueError, RecursionError, OverflowError) as error:
            return Refusal(f"body is not a {KINDS[frame[3]].__name__}: {error}")
