"""What the launcher does about processes that end while the run goes on: start them again, as `policy` says, or not.

Rules: it looks when it is told to and decides nothing by itself; time comes in as an argument. A robot that a planned
fault ends is started again if that fault says so, and whatever the table says; its end counts for nothing. The world is
started again when it keeps checkpoints.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from deploy.launch.children import Child, Children
from deploy.launch.policy import GiveUp, Mode, Policy, how
from protocol import keys
from protocol.errors import SwarmFailure
from protocol.messages import Inject
from protocol.scenario import Scenario
from protocol.scenario.faults import Crash, first_tick


@dataclass(slots=True)
class Supervisor:
    """The processes of one run that may be started again."""

    scenario: Scenario
    children: Children
    start: Callable[[str], None]  # a member's process, once more
    tell: Callable[[int, str], None]  # (robot or -1, what a person wants to know)
    _policies: dict[str, Policy] = field(default_factory=dict)
    _due: dict[str, float] = field(default_factory=dict)  # when who is started again
    _seen: set[int] = field(default_factory=set)  # processes whose end has been dealt with
    _planned: dict[str, float | None] = field(default_factory=dict)  # ended by a fault; started again after so many s

    @property
    def keeps_world(self) -> bool:
        """Whether a world that ends is started again."""
        return self.scenario.supervision.checkpoint_every > 0.0

    def planned(self, order: Inject) -> None:
        """A planned fault ends a robot's process now."""
        scenario = self.scenario
        pause = None
        for fault in scenario.faults:
            if not isinstance(fault, Crash) or fault.robot != order.robot or fault.restart == 0.0:
                continue
            if first_tick(fault.at, scenario.timing.tick) == order.tick:
                # In lock-step the new process waits until the world calls it; in real time nobody does.
                pause = fault.restart / scenario.realtime.speed if scenario.clock == "realtime" else 0.0
        self._planned[keys.robot_name(order.robot)] = pause

    def look(self, now: float) -> None:
        """Deal with who has ended, and start again who is due.

        Raises: SwarmFailure when the world is given up.
        """
        for name, child in self.children.members.items():
            status = child.status
            if status is not None and child.process.pid not in self._seen:
                self._seen.add(child.process.pid)
                self._ended(name, child, status, now)
        for name in [name for name, at in self._due.items() if at <= now]:
            del self._due[name]
            self.start(name)

    def _ended(self, name: str, child: Child, status: int, now: float) -> None:
        robot = keys.robot_of(name)
        if name in self._planned and status < 0:
            if (pause := self._planned.pop(name)) is not None:
                self._due[name] = now + pause
            return
        if name == keys.WORLD and self.keeps_world:
            mode = Mode.CRASHED
        elif robot is not None:
            mode = Mode(self.scenario.supervision.restart)
        else:
            return
        policy = self._policies.setdefault(name, Policy(mode, self.scenario.supervision))
        decision = policy.ended(now, status)
        who, words = (f"robot {robot}" if robot is not None else "the world"), child.last_words()
        said = f": {words}" if words else ""
        if isinstance(decision, GiveUp):
            if robot is None:
                raise SwarmFailure(f"{who} {decision.why}{said or '.'}")
            self.tell(robot, f"{who} {decision.why}{said}")
        elif decision is not None:
            self._due[name] = decision.at
            pause = decision.at - now
            when = f" in {pause:.1f} s" if pause > 0.0 else ""
            self.tell(-1 if robot is None else robot, f"{who} {how(status)} and is started again{when}{said}")
