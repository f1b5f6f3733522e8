"""The world's bulk noise: numpy generators that are addressed, never ordered.

Rules: a stream depends on its address only, (seed, *address), and for step noise on the step number; never on what was
drawn before. The bit generator is Philox, a counter-based one: the key is the address (`protocol.randomness.key_for`),
the second word of the counter is the step, the first counts the blocks drawn within the step.
"""

from __future__ import annotations

from typing import Any

from numpy.random import Generator, Philox

from protocol.randomness import key_for

_WORD = (1 << 64) - 1


def generator_for(seed: int, *address: int | str) -> Generator:
    """Numpy generator at the start of the stream that belongs to `(seed, *address)`."""
    return Generator(Philox(key=key_for(seed, *address)))


class StepNoise:
    """One independent stream per step number, without the cost of making a generator at every step."""

    __slots__ = ("_bits", "_counter", "_generator", "_state")

    def __init__(self, seed: int, *address: int | str) -> None:
        key = key_for(seed, *address)
        self._bits = Philox(key=key)
        self._generator = Generator(self._bits)
        self._counter = [0, 0, 0, 0]
        # The whole state of a Philox that has drawn nothing: empty buffer, no half-used 64-bit word.
        self._state: Any = {
            "bit_generator": "Philox",
            "state": {"counter": self._counter, "key": [key & _WORD, key >> 64]},
            "buffer": [0, 0, 0, 0],
            "buffer_pos": 4,
            "has_uint32": 0,
            "uinteger": 0,
        }

    def at(self, k: int) -> Generator:
        """Generator at the start of step `k`'s stream, 0 <= k < 2^64; the next call of `at` moves the same object.

        `at(0)` is the stream of `generator_for` with the same address.
        """
        self._counter[1] = k
        self._bits.state = self._state
        return self._generator
