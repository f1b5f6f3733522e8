"""What a neighbour says is used only when a body, a clock and a sensor could have produced it.

Rules: pure; a state that is impossible is counted under its sender and a reason, and the sender counts as silent at this
tick. After that it is believed again when `trust.readmit` possible states in a row have come from it, so that one bad
state costs little and a robot that was put elsewhere is not shut out for ever. All robots keep the same bounds, so that
what an honest robot passes on is never a reason not to believe it. Bounds: scenario table `trust`.

Checked: the place (in or near the arena, no farther from the last one than a body can drive), the velocity, the tick,
the times (not in the future, first before last), the best concentration (what a sensor can measure, at a place in the
arena), the search (a leg that could have been reached, a heading that is a direction), and, once the group has detected
the odour, fusion state and decision (in or near the arena), and the virtual robot (on its leash). Of the states that it
passes on for others only the impossible ones are left out: places that contradict what this robot heard from the other
itself, or heard before. There is no variance among what robots tell each other, so that nobody can gain weight by
claiming a small one; the weights a_ij are the listener's own.

What a liar can still do in its own name: say "I smell it now" at every tick, so that the group never gives up a place
where nothing is; claim a best concentration somewhere in the arena, up to the bound, which counts for
`decision.recall` seconds after it is claimed (for ever when that is 0), and so move the oscillation centre p_hat (2.4)
of all, a share c_2 of h^ic (3.31); lead the search from leg to leg; hold a false fusion state in the arena (against
that: fusion.kind = "resilient"); and say from the start, or by drifting as slowly as a body drives, that it is where it
is not: the consensus laws of chapters 5 and 6 know no other place of a neighbour and follow it (docs/lab.md has the
effects). A robot's `notes` and `events` are the algorithm's own and are not checked. Neither are the votes and the
declaration that it passes on: they are mostly others' words, and one false declaration is adopted by all who hear it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from math import hypot

from msgspec.structs import replace

from protocol.messages import Shared
from protocol.scenario import RobotScenario
from robot_agent.hand import Own
from robot_agent.interfaces import Controller
from robot_agent.neighbours import Relayed

NEW_LEGS = 2  # legs of the search that one robot can begin in a tick: once when it senses, once when it acts


class Validation:
    """One robot's judgement of its neighbours."""

    def __init__(self, scenario: RobotScenario, controller: Controller) -> None:
        """`controller` judges the numbers that are its own."""
        trust, body, timing = scenario.trust, scenario.body, scenario.timing
        self.rejected: Counter[tuple[int, str]] = Counter()  # (sender, reason) -> how often
        self._trust = trust
        self._controller = controller
        self._me = scenario.robot
        self._robots = scenario.robots
        self._arena = scenario.arena
        self._may_stand = scenario.search.after == "stay"
        self._dt = timing.tick
        self._top = trust.speed * hypot(body.max_speed, body.hand * body.max_turn)  # of a hand, m/s
        self._ahead = round(trust.skew / timing.tick)
        self._forget = round(scenario.control.relay_age / timing.tick)
        self._believed: dict[int, Relayed] = {}  # where each neighbour was last, by itself
        self._passed_on: dict[int, Relayed] = {}  # where others were last, by what neighbours pass on
        self._probation: dict[int, tuple[int, Relayed]] = {}  # possible states since the last impossible one; the latest

    @property
    def total(self) -> int:
        """States and passed-on states that were not believed."""
        return self.rejected.total()

    def sift(self, own: Own, heard: Iterable[Shared]) -> list[Shared]:
        """The states of `heard` that can be believed at this tick."""
        if not self._trust.check:
            return list(heard)
        believed = [state for state in heard if self._believes(own, state)]
        return [self._without_contradictions(own, state) if state.relayed else state for state in believed]

    def _believes(self, own: Own, state: Shared) -> bool:
        here: Relayed = (state.robot, state.tick, state.x, state.y, state.vx, state.vy)
        j = state.robot
        on_probation = self._probation.get(j)
        before = self._believed.get(j) if on_probation is None else on_probation[1]
        reason = self._impossible(own, state)
        if reason is None and before is not None and not self._reachable(before, here):
            reason = "jump"
        if reason is not None:
            self.rejected[j, reason] += 1
            # A place that is possible in itself may be where it is from now on; what is not, is nowhere.
            self._probation[j] = (0, here if reason == "jump" or before is None else before)
            return False
        if on_probation is not None:
            count, latest = on_probation
            if here[1] > latest[1]:  # the same state again shows nothing
                count += 1
            if count < self._trust.readmit:
                self._probation[j] = (count, max(here, latest, key=_tick))
                self.rejected[j, "probation"] += 1
                return False
            del self._probation[j]
            self._believed[j] = here
        elif before is None or here[1] > before[1]:
            self._believed[j] = here
        return True

    def _impossible(self, own: Own, s: Shared) -> str | None:
        """Why `s` cannot be, whatever came before it; None: it can."""
        if not 0 <= s.tick <= own.tick + self._ahead:
            return "tick"
        return self._impossible_body(s) or self._impossible_claim(own, s)

    def _impossible_body(self, s: Shared) -> str | None:
        if not self._inside(s.x, s.y, self._trust.margin):
            return "place"
        return "speed" if s.vx * s.vx + s.vy * s.vy > self._top * self._top else None

    def _impossible_claim(self, own: Own, s: Shared) -> str | None:
        trust = self._trust
        first, last = s.first_detected_at, s.detected_at
        latest = own.t + trust.skew
        if not (first <= last <= latest and s.best_at <= latest and (first < 0.0) == (last < 0.0)):
            return "time"
        smelt = s.best_concentration
        if not 0.0 <= smelt <= trust.concentration or (smelt and not self._inside(s.best_x, s.best_y, trust.margin)):
            return "concentration"
        if not self._can_search(s):
            return "search"
        if first >= 0.0:
            far = trust.decided_margin
            if not (self._inside(s.fusion_x, s.fusion_y, far) and self._inside(s.h_x, s.h_y, far)):
                return "decision"
        return None if self._controller.believes(own, s) else "virtual"

    def _can_search(self, s: Shared) -> bool:
        if s.search_leg < 0:
            return s.search_leg == -1
        if s.search_leg > NEW_LEGS * (s.tick + 1) or not 0 <= s.search_by < self._robots:
            return False
        length = hypot(s.search_x, s.search_y)
        stands = length == 0.0 and s.search_leg > 0 and self._may_stand
        return stands or abs(length - 1.0) < 1e-6

    def _without_contradictions(self, own: Own, state: Shared) -> Shared:
        """`state` without the places of others that cannot be."""
        kept = tuple(record for record in state.relayed if self._can_be(own, record, state.robot))
        return state if len(kept) == len(state.relayed) else replace(state, relayed=kept)

    def _can_be(self, own: Own, record: Relayed, sender: int) -> bool:
        j, tick, x, y, vx, vy = record
        if j == self._me:
            return True  # of no use, and of no harm
        possible = (
            0 <= j < self._robots
            and 0 <= tick <= own.tick + self._ahead
            and self._inside(x, y, self._trust.margin)
            and vx * vx + vy * vy <= self._top * self._top
        )
        if possible and (direct := self._believed.get(j)) is not None:
            possible = self._reachable(direct, record)
        elif possible and (known := self._passed_on.get(j)) is not None and own.tick - known[1] <= self._forget:
            possible = self._reachable(known, record)
        if not possible:
            self.rejected[sender, "relayed"] += 1
            return False
        if j not in self._passed_on or tick > self._passed_on[j][1]:
            self._passed_on[j] = record
        return True

    def _inside(self, x: float, y: float, margin: float) -> bool:
        arena = self._arena
        return (
            arena.x_min - margin <= x <= arena.x_max + margin and arena.y_min - margin <= y <= arena.y_max + margin
        )

    def _reachable(self, before: Relayed, now: Relayed) -> bool:
        """Whether a body can have come from one place to the other, or the other way round for a late state."""
        way = hypot(now[2] - before[2], now[3] - before[3])
        return way <= self._top * abs(now[1] - before[1]) * self._dt + self._trust.slack


def _tick(record: Relayed) -> int:
    return record[1]
