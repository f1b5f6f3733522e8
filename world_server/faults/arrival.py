"""When a state arrives that was sent over an edge."""

from __future__ import annotations

from typing import NamedTuple, Protocol

IN_TURN, BEHIND = 0, 1


class Arrival(NamedTuple):
    """A state is heard at `tick`, in turn or behind those that arrive in turn."""

    tick: int
    turn: int = IN_TURN


class Effect(Protocol):
    """What one fault does to the states that are sent."""

    longest: int  # ticks by which it makes a state late at most

    def __call__(self, i: int, j: int, sent: int, arrivals: list[Arrival]) -> list[Arrival]:
        """The arrivals at robot i of what robot j sent at tick `sent`, which would have been `arrivals` without it."""
        ...
