"""A robot's history: what it sent, heard and used, as records.

Rules: pure; the shell gives the pen. What changes at decisions only is written when it has changed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from protocol import keys
from protocol.history.records import VERSION, Acted, Begin, Mind, Record, Sent, content_of
from protocol.messages import Drive, Shared
from robot_agent.agent import Agent
from robot_agent.interfaces import Decision, Fresh


class RobotHistory:
    """The observer of one robot that writes down what it sees; a `robot_agent.observer.Observer`."""

    __slots__ = ("_fuses", "_mind", "_write")

    def __init__(self, agent: Agent, run: str, write: Callable[[Record], None]) -> None:
        """Begin to observe `agent`."""
        self._write = write
        self._mind: Mind | None = None
        self._fuses = agent.fuses
        write(Begin(VERSION, run, keys.robot_name(agent.robot), b"", agent.fuses))
        agent.observer = self

    def told(self, shared: Shared) -> None:
        fusion = (shared.fusion_x, shared.fusion_y)
        begun = shared.first_detected_at >= 0.0
        self._write(Sent(shared.tick, content_of(shared), shared.x, shared.y, fusion, begun))

    def acted(
        self, heard: Sequence[Shared], fresh: Fresh, decision: Decision, mode: str, drive: Drive, *, begun: bool
    ) -> None:
        tick = drive.tick
        fuses = begun and self._fuses
        mind: Mind | None = Mind(mode, decision.estimate.P, decision.input if fuses else None)
        if mind == self._mind:
            mind = None
        else:
            self._mind = mind
        self._write(
            Acted(
                tick,
                tuple([(s.robot, tick - s.tick, content_of(s)) for s in heard]),
                tuple([
                    (s.robot, tick - s.tick, a, (s.fusion_x, s.fusion_y) if s.first_detected_at >= 0.0 else None)
                    for a, s in fresh
                ]),
                decision.state if fuses else None,
                mind,
                drive.tau_left,
                drive.tau_right,
            )
        )  # fmt: skip
