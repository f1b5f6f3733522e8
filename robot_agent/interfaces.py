"""The interface of an algorithm: a decision (where is the source?), a planner (where to go?), a controller (how?).

Rules: each part is made from the robot's scenario; it is given what the robot knows and returns plain values; it never
sees a message it was not allowed to hear. A part names its interface as its base and overrides what it needs. A new
algorithm is one new file for what is new in it and one line in `robot_agent.algorithms`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from protocol.messages import Reading, Shared
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.kalman import Estimate
from robot_agent.neighbours import Placed

Point = tuple[float, float]
# x0, y0 (corner of the first cell, m), cell (m), rows, and one byte per cell, row by row towards +y, within a row towards
# +x: 255 sqrt(p / p_max), p the probability that the source is in the cell
BeliefMap = tuple[float, float, float, int, bytes]
Fresh = Sequence[tuple[float, Shared]]  # (a_ij, state) of the neighbours that count now


class Posterior(NamedTuple):
    """Where a decision takes the source to be: mean, m, and covariance, m^2."""

    x: float
    y: float
    xx: float
    xy: float
    yy: float


OFTEN = 1 << 30  # more meetings than anybody asks for
SEARCH, TRACE, LOST = "search", "trace", "lost"


class Around(NamedTuple):
    """The other robots, as far as one knows of them."""

    fresh: Fresh  # neighbours on the graph, with all that they say
    others: Sequence[Placed]  # everyone whose place is known, neighbours or not
    numbers: Sequence[int] = ()  # their robot numbers, in the same order


@dataclass(frozen=True, slots=True)
class Plan:
    """Where to go until the next decision."""

    mode: str  # SEARCH | TRACE | LOST
    target: Point  # p_i, m
    p_dot: Point = (0.0, 0.0)  # its velocity, m/s
    p_ddot: Point = (0.0, 0.0)  # its acceleration, m/s^2
    v_c: Point = (0.0, 0.0)  # reference velocity v_c^i, m/s
    centre: Point = (0.0, 0.0)  # decision h^ic, the centre of circular motion, m


class Decision(Protocol):
    """Makes h^ic, the decided position of the source."""

    state: Point  # what travels to the neighbours as the fusion state
    h: Point
    estimate: Estimate
    recall: float = 0.0  # how long the best concentration counts (`robot_agent.recall`), s; 0: for ever
    decides: bool = True  # False: h is a place to drive to, nothing is said about the source
    fuses: bool = False  # whether `estimate` is a Kalman filter's and `state` the fusion's (3.26) with `input`
    word: tuple[float, float, float] | None = None  # its own measurements' estimate and their time (`robot_agent.words`)
    input: Point | None = None  # u_i of the fusion, m; None: it did not measure

    def prefill(self, reading: Reading) -> None:
        """Take the wind that was recorded before the start."""
        return

    def record(self, own: Own) -> None:
        """At every decision instant from the start on: remember what is sensed."""
        return

    def begin(self, own: Own) -> None:
        """Someone has detected the odour for the first time (or the algorithm begins at once)."""
        ...

    def rejoin(self, own: Own, fresh: Fresh) -> None:
        """After `begin` when this robot joins a swarm that is on its way: take back what the neighbours know."""
        return

    def detect(self, own: Own) -> None:
        """This robot detects the odour now."""
        return

    def decide(self, own: Own, group: Group, detected: bool, around: Around) -> None:
        """At every decision instant after `begin`."""
        ...

    def advance(self, fresh: Fresh, dt: float) -> None:
        """At every tick after `begin`: exchange with the neighbours."""
        return

    def notes(self, own: Own) -> tuple[float, ...]:
        """Own numbers to tell the neighbours at this tick (`Shared.notes`)."""
        return ()

    def listen(self, own: Own, heard: Iterable[Shared]) -> None:
        """At every tick from the start on: all that arrived, late states too."""
        return

    def events(self, own: Own) -> bytes:
        """Own bytes to tell the neighbours at this tick (`Shared.events`)."""
        return b""

    def posterior(self) -> Posterior | None:
        """Mean and covariance of the position of the source; None: they are not known (yet)."""
        return None

    def certainty(self) -> float | None:
        """How well the position of the source is known: root of the trace of its covariance, m; None: it is not said."""
        return None

    def meetings(self, since: float, place: Point) -> int:
        """How often the odour was met again since then (s), as a source at `place` (m) explains it. May be slow.

        Algorithms that cannot say have met it often enough.
        """
        return OFTEN

    def belief_map(self) -> BeliefMap | None:
        """Where the source may be, for whoever watches; None: there is no such map (yet). May be slow: ask rarely."""
        return None


class Planner(Protocol):
    """Makes a plan from the decision."""

    def brief(self, own: Own, decision: Decision, group: Group, around: Around) -> None:
        """Just before `plan`: all that the decision knew, for plans that need more than h."""
        return

    def plan(self, own: Own, h: Point, lost: bool) -> Plan:
        """At every decision instant after `begin`."""
        ...

    def follow(self, own: Own, plan: Plan) -> Plan:
        """At every tick after `begin`: the plan as it is now, for plans that move between decisions."""
        return plan


class Controller(Protocol):
    """Makes the control signal u_i of (1.7) from the plan, at every tick."""

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        """u_i, m/s^2."""
        ...

    def believes(self, own: Own, state: Shared) -> bool:
        """Whether a neighbour's own numbers (`Shared.virtual`) can be true (robot_agent.validation)."""
        return True

    def virtual(self) -> tuple[float, ...]:
        """Own numbers to tell the neighbours at the next tick (`Shared.virtual`)."""
        return ()
