"""Randomness is addressed, never ordered: a draw depends on its name, not on who ran first.

    rng_for(seed, "link", i, j, k).uniform()

gives the same number in every process, on either bus, whatever was drawn before. The generator is BLAKE2b in counter
mode: light enough for a robot process that does not load numpy. The world's bulk noise uses `key_for` as the key of a
counter-based numpy generator (`world_server.noise`).
"""

from __future__ import annotations

import math
from hashlib import blake2b

_SCALE = 2.0**-53


def key_for(seed: int, *address: int | str) -> int:
    """128-bit key of an address; distinct addresses (of text without control characters) give independent keys."""
    # The type marks keep 1 and "1" apart; the separator keeps ("a", "b") and ("ab",) apart.
    text = "\x1f".join(f"i{part}" if isinstance(part, int) else f"s{part}" for part in (seed, *address))
    return int.from_bytes(blake2b(text.encode(), digest_size=16).digest(), "little")


class Draws:
    """The stream of draws that belongs to one address."""

    __slots__ = ("_key", "_next")

    def __init__(self, key: int) -> None:
        self._key = key.to_bytes(16, "little")
        self._next = 0

    def uniform(self) -> float:
        """One draw from U[0, 1), with 53 random bits."""
        block = blake2b(self._next.to_bytes(8, "little"), key=self._key, digest_size=8).digest()
        self._next += 1
        return (int.from_bytes(block, "little") >> 11) * _SCALE

    def normal(self) -> float:
        """One draw from N(0, 1) (Box-Muller, cosine branch)."""
        u1, u2 = self.uniform(), self.uniform()
        return math.sqrt(-2.0 * math.log1p(-u1)) * math.cos(2.0 * math.pi * u2)


def rng_for(seed: int, *address: int | str) -> Draws:
    """The draws that belong to `(seed, *address)`, from the first one on."""
    return Draws(key_for(seed, *address))
