"""What a checker is, and what it says.

Rules: a checker is a pure function over a history. It goes through the facts that it is about in the order of time and
gives for each None, when the promise was kept, or a sentence that says who broke it, at which tick and how; the first
sentence is its counter-example. A promise that cannot be asked of this run is skipped, with the reason.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from msgspec import Struct

from deploy.checkers.history import History

Facts = Iterator[str | None]


class Finding(Struct, frozen=True):
    """What one checker says of one run."""

    name: str
    promise: str
    passed: bool
    facts: int  # how many were looked at, up to the counter-example
    counterexample: str | None = None
    skipped: str | None = None  # why there was nothing to look at


@dataclass(frozen=True, slots=True)
class Checker:
    """One promise and how it is looked at."""

    name: str
    promise: str
    facts: Callable[[History], Facts]
    skip: Callable[[History], str | None] = lambda _: None  # why this run did not make the promise

    def look(self, history: History) -> Finding:
        """Go through the facts up to the first that breaks the promise."""
        if (reason := self.skip(history)) is not None:
            return Finding(self.name, self.promise, True, 0, skipped=reason)
        looked = 0
        for fact in self.facts(history):
            looked += 1
            if fact is not None:
                return Finding(self.name, self.promise, False, looked, counterexample=fact)
        return Finding(self.name, self.promise, True, looked)
