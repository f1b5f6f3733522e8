"""What a robot hears in real time: of the states that have come over its wires, those that the radio lets through.

Rules: pure. The radio is emulated by the world as in lock-step: it draws the fate of every state (loss, delay, order,
partition, range) by edge and tick, and every reading says in `hears` which states come through at its tick. A state is
heard once for each time that a reading lets it through, as soon as it is there, too; over real wires one that was sent
at this very tick comes a little later and is heard at the next. What is never let through is never heard.
"""

from __future__ import annotations

from protocol.messages import Reading, Shared

KEPT = 64  # ticks that a state, or the permission to hear it, is kept

Sent = tuple[int, int]  # neighbour, tick of sending


class Reception:
    """States on one side, permissions on the other."""

    __slots__ = ("_allowed", "_states")

    def __init__(self) -> None:
        self._allowed: list[Sent] = []  # not heard yet, in the order of the readings
        self._states: dict[Sent, Shared] = {}

    def allow(self, reading: Reading) -> None:
        """Take the permissions of a reading."""
        self._allowed += reading.hears

    def take(self, state: Shared, tick: int) -> bool:
        """Keep a state that arrived; False when it came twice or is older than what is kept at `tick`."""
        sent = (state.robot, state.tick)
        if sent in self._states or state.tick <= tick - KEPT:
            return False
        self._states[sent] = state
        return True

    def heard(self, tick: int) -> list[Shared]:
        """What is heard at `tick`: neighbours' states that are there and were let through since the last call."""
        oldest, states = tick - KEPT, self._states
        heard = [states[sent] for sent in self._allowed if sent in states]
        self._allowed = [sent for sent in self._allowed if sent not in states and sent[1] > oldest]
        for sent in [sent for sent in states if sent[1] <= oldest]:
            del states[sent]
        return heard
