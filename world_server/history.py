"""The world's history: bodies, drives, who is held, who may hear whom, the verdict, as records.

Rules: pure; the shell gives the pen. It reads the world and changes nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import msgspec

from protocol import keys
from protocol.bus import Publish
from protocol.history.records import VERSION, Begin, Moved, Record, Result, Told, Verdict
from protocol.messages import Drive, Halt, Message, Outcome, Reading
from world_server.world import World


class WorldHistory:
    """The observer of the world that writes down what it sees; a `world_server.observer.Observer`."""

    __slots__ = ("_world", "_write")

    def __init__(self, world: World, run: str, write: Callable[[Record], None]) -> None:
        """Begin to observe `world`."""
        self._world = world
        self._write = write
        write(Begin(VERSION, run, keys.WORLD, msgspec.json.encode(world.scenario), False))
        self.stepped({}, sampled=True)
        world.observer = self

    def stepped(self, drives: Mapping[int, Drive], *, sampled: bool) -> None:
        world = self._world
        bodies, live = world.bodies, world.live
        self._write(
            Moved(
                world.tick,
                tuple([(b.x, b.y, b.theta, b.nu, b.omega) for b in bodies.robots]),
                tuple([(i, drive.tau_left, drive.tau_right) for i, drive in sorted(drives.items())]),
                tuple([i for i, held in enumerate(bodies.braking) if held]),
                tuple([i for i in range(len(bodies.robots)) if i not in live]),
                tuple(world.concentration) if sampled else None,
            )
        )

    def told(self, tick: int, readings: Sequence[Reading]) -> None:
        hears = tuple([(r.robot, tuple([(j, tick - k) for j, k in r.hears])) for r in readings])
        self._write(Told(tick, hears))

    def halting(self, halt: Publish) -> Publish:
        """`halt`, with the verdict written down before it is said."""

        def write_and_halt(message: Message) -> None:
            if isinstance(message, Halt):
                self._write(Verdict(message.tick, message.reason))
            halt(message)

        return write_and_halt

    def result(self, outcome: Outcome) -> None:
        """How it ended, before anybody is told."""
        self._write(Result(outcome.found, outcome.finder, outcome.time, outcome.ended, outcome.digest))
