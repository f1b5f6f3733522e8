"""A world that was killed comes back: it gathers the robots that had not left it.

Rules: part of the shell. A robot that lived on says who its neighbours are (`Linked`) when it sees the world again, and
knows the world's subscriptions by then; a robot whose process is new asks to join, and has lost what it knew. Who has
said nothing within `network.return_timeout` is lost; nobody is waited for longer.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable

from protocol import keys
from protocol.bus import Asked, Bus, Delivery, Lost, Seen
from protocol.messages import Join, Linked
from world_server.recoverable import RecoverableSession

POLL = 0.02  # s between two looks at what is not an event


def gather_again(
    bus: Bus, session: RecoverableSession, members: Iterable[str], answer: Callable[[Asked], None], patience: float
) -> None:
    """Wait for the robots that take part and for `members` (recorder, launcher), at most `patience` seconds."""
    waiting, absent, fresh = set(session.world.live), set(members), set[int]()
    deadline = time.monotonic() + patience
    while waiting or absent:
        event = bus.receive(POLL)
        if isinstance(event, Delivery):
            message = event.message
            if isinstance(message, Linked) and keys.robot_of(event.key) == message.robot:
                session.take_linked(message)
                if bus.matched(keys.robot(message.robot, keys.READING), (keys.robot_name(message.robot),)):
                    waiting.discard(message.robot)
        elif isinstance(event, Asked):
            if isinstance(event.message, Join) and (i := event.message.robot) in session.world.live:
                session.lose(i, "lost while the world was away")
                waiting.discard(i)
                fresh.add(i)
            answer(event)
        elif isinstance(event, Seen):
            absent.discard(event.name)
            if (i := keys.robot_of(event.name) or 0) not in session.world.live and keys.robot_of(event.name) is not None:
                fresh.add(i)
        elif isinstance(event, Lost) and (lost := keys.robot_of(event.name)) is not None:
            session.lose(lost)
            waiting.discard(lost)
            fresh.discard(lost)
        if time.monotonic() > deadline:
            break
    for i in sorted(waiting):
        session.lose(i, "lost while the world was away")
    session.go_on()
    for i in sorted(fresh):
        session.come(i)
