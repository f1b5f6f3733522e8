"""The port between the swarm and its wires.

Rules: a member publishes and receives typed messages; bytes, sockets and threads stay behind the port. What arrives is
handed out one event at a time by `receive`, in the caller's thread. Nothing foreign ever raises out of `receive`: it is
counted and dropped. Two implementations: `MemoryBus` (one process, deterministic) and `ZenohBus` (peer to peer).

A member is called "world", "robot/3", "recorder" or "launcher". Members that are linked see each other's liveliness;
members that are not linked see nothing of each other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from msgspec import Struct

from protocol.messages import Message

# Events are msgspec records like the messages: one is made per message, and they cost a fifth of a frozen dataclass.


class Delivery(Struct, frozen=True, gc=False):
    """A message that arrived under a key (without the run's prefix)."""

    key: str
    message: Message


class Seen(Struct, frozen=True, gc=False):
    """A linked member came to life."""

    name: str


class Lost(Struct, frozen=True, gc=False):
    """A linked member is gone: it left, died, or hung for a lease."""

    name: str


class Asked(Struct, frozen=True):
    """A query that waits for `answer` to be called once."""

    key: str
    message: Message
    answer: Callable[[Message], None]


BusEvent = Delivery | Seen | Lost | Asked
Publish = Callable[[Message], None]


@dataclass(slots=True)
class Counters:
    """What went over a member's wires.

    `refused`: malformed, foreign, of a kind that is not said there. `dropped`: for want of room; sessions add
    to it what came too late, twice, or unasked.
    """

    sent: int = 0
    received: int = 0
    dropped: int = 0
    refused: int = 0


class Bus(Protocol):
    """One member's access to the run."""

    name: str
    counters: Counters

    def publisher(self, key: str, *, reliable: bool) -> Publish:
        """Declare a publication. `reliable`: the sender waits rather than lose it, for traffic with at most one small
        message per peer in flight; otherwise the message is dropped when a link is congested."""
        ...

    def subscribe(self, key: str, *kinds: type[Message]) -> None:
        """Receive `kinds` under `key` ("robot/*/shared" matches any robot); other kinds there are refused."""
        ...

    def serve(self, key: str, kind: type[Message]) -> None:
        """Receive queries under `key` as `Asked` events."""
        ...

    def ask(self, key: str, question: Message, timeout: float) -> Message | None:
        """First reply to a query, or None when nobody answered within `timeout` seconds."""
        ...

    def receive(self, timeout: float | None) -> BusEvent | None:
        """Next event; None after `timeout` seconds without one (0: do not wait)."""
        ...

    def links(self) -> frozenset[str]:
        """Names of the members that this one is physically linked to now."""
        ...

    def matched(self, key: str, names: Sequence[str]) -> bool:
        """Whether the publication `key` has a subscriber (all of `names` where the wires can tell)."""
        ...

    def close(self) -> None:
        """Leave the run; idempotent."""
        ...
