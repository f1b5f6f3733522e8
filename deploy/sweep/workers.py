"""The worker processes of a sweep.

Rules: each worker is a fresh interpreter on a leash (its standard input) and has one run at a time; one that dies is
noticed by the end of its output, its run is done once more at the end of the queue, then given up. No worker outlives
the sweep: they are killed on the way out, and end by themselves when the sweep was killed.
"""

from __future__ import annotations

import selectors
from collections import Counter, deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from types import TracebackType

from deploy.sweep.handle import Handle, start
from deploy.sweep.plan import Job
from deploy.sweep.worker import Answer
from protocol.errors import SwarmFailure
from protocol.messages import Outcome

TRIES = 2  # of a run whose worker died
STARTS = 3  # workers in a row that may die before they are ready


@dataclass(frozen=True, slots=True)
class Result:
    """How a run ended: with an outcome, or with the sentence that says why there is none."""

    job: Job
    outcome: Outcome | None
    error: str = ""
    broken: str | None = None  # see `worker.Answer`


class Workers:
    """At most so many workers; as a context, which ends them."""

    def __init__(self, most: int, *, check: bool = False) -> None:
        self._most = most
        self._check = check
        self._selector = selectors.DefaultSelector()
        self._members: list[Handle] = []
        self._queue: deque[Job] = deque()
        self._tries: Counter[str] = Counter()
        self._failed_starts = 0
        self.lost = 0  # workers that died during a run

    def __enter__(self) -> Workers:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for member in self._members:
            member.kill()
        for member in self._members:
            member.bury()
        self._members.clear()
        self._selector.close()

    def run(self, jobs: Sequence[Job], pause: float) -> Iterator[Result | None]:
        """Run `jobs`; their results as they come, and None when none came for `pause` seconds.

        Raises: SwarmFailure when workers cannot be started.
        """
        self._queue.extend(jobs)
        unfinished = len(jobs)
        while unfinished:
            self._hand_out()
            results = [result for member in self._wait(pause) for result in self._hear(member)]
            unfinished -= len(results)
            yield from results or (None,)

    def _hand_out(self) -> None:
        """Give whoever is free something to do; start workers while there is more."""
        for member in self._members:
            if member.ready and member.job is None and self._queue:
                member.give(self._queue.popleft())
        starting = sum(not member.ready for member in self._members)
        while len(self._members) < self._most and starting < len(self._queue):
            member = start(check=self._check)
            self._members.append(member)
            self._selector.register(member.output, selectors.EVENT_READ, member)
            starting += 1

    def _wait(self, pause: float) -> list[Handle]:
        """The workers that have something to say, within `pause` seconds."""
        return [key.data for key, _ in self._selector.select(pause)]

    def _hear(self, member: Handle) -> Iterator[Result]:
        """The results in what `member` says, or in its death."""
        answers = member.answers()
        if answers is None:
            yield from self._lose(member)
            return
        for answer in answers:
            yield from self._take(member, answer)

    def _take(self, member: Handle, answer: Answer) -> Iterator[Result]:
        job, member.job = member.job, None
        if answer.ready:
            member.ready, self._failed_starts = True, 0
        elif job is not None:
            yield Result(job, answer.outcome, answer.error, answer.broken)

    def _lose(self, member: Handle) -> Iterator[Result]:
        """A worker has died: its run has another chance."""
        self._selector.unregister(member.output)
        self._members.remove(member)
        how = member.bury()
        job = member.job
        if not member.ready:
            self._failed_starts += 1
            if self._failed_starts >= STARTS:
                raise SwarmFailure(f"the sweep's worker processes cannot start ({how}).")
        if job is None:
            return
        self.lost += 1
        self._tries[job.digest] += 1
        if self._tries[job.digest] < TRIES:
            self._queue.append(job)
        else:
            yield Result(job, None, f"its process died {TRIES} times ({how}); fewer --jobs leave each more memory.")
