"""One robot: from a reading to what it tells its neighbours, and from what it hears to what it drives.

Rules: pure; a tick is `sense(reading)` and then `act(heard)`, in this order, once each. In real time ticks may be
missing, then a decision is due at the first tick after its instant, and the exchange of the missing ticks is missing,
too. The same object runs in a process of its own over Zenoh and beside others in memory, bit for bit alike.
"""

from __future__ import annotations

from collections.abc import Iterable

from protocol.messages import Belief, BeliefMap, Drive, Reading, Shared
from protocol.scenario import RobotScenario
from robot_agent.algorithms import algorithm
from robot_agent.control.guard import Guard
from robot_agent.declaration import Declaration
from robot_agent.group import Group
from robot_agent.hand import Own, wheel_torques
from robot_agent.interfaces import Around, Plan
from robot_agent.map_telemetry import PERIOD, map_message
from robot_agent.neighbours import Neighbours
from robot_agent.observer import Observer
from robot_agent.planning.search import CrosswindSearch
from robot_agent.proximity import Proximity
from robot_agent.rejoin import Rejoin, at_rest
from robot_agent.validation import Validation


class Agent:
    """The belief of robot `scenario.robot`."""

    def __init__(self, scenario: RobotScenario) -> None:
        parts = algorithm(scenario.algorithm)
        self.robot = scenario.robot
        self.scenario = scenario
        self.observer: Observer | None = None
        self._s = scenario
        self._decision = parts.decision(scenario)
        self._planner = parts.planner(scenario)
        self._controller = parts.controller(scenario)
        self._search = CrosswindSearch(scenario)
        self._group = Group(self._decision.recall)
        self._neighbours = Neighbours(scenario)
        self._rejoin = Rejoin(scenario)
        self.validation = Validation(scenario, self._controller)
        self._declaration = Declaration(scenario)
        self._proximity = Proximity(scenario) if scenario.proximity > 0.0 else None
        self.guard = Guard(scenario) if self._proximity is not None and scenario.repulsion.keep > 0.0 else None
        self._near2 = scenario.repulsion.d**2  # silent robots farther than that push and pull nobody, m^2
        self._dt = scenario.timing.tick
        self._ticks_per_decision = round(scenario.timing.decision / scenario.timing.tick)
        self._ticks_per_map = self._ticks_per_decision * max(1, round(PERIOD / scenario.timing.decision))
        self._own: Own | None = None
        self._at_once = parts.at_once
        self._begun = False
        self._detected = False
        self._plan: Plan | None = None

    @property
    def decision_due(self) -> bool:
        """Whether the tick that was sensed last is one of decision, or the first one after readings that were missed."""
        return self._own is not None and self._own.due(self._ticks_per_decision)

    @property
    def fuses(self) -> bool:
        """Whether its decision filters and fuses (3.26)."""
        return self._decision.fuses

    @property
    def estimate(self) -> tuple[float, float] | None:
        """The decided position of the source h^ic, m; None before the first detection in the group, and for an algorithm
        that decides nothing."""
        return self._decision.h if self._begun and self._decision.decides else None

    def sense(self, reading: Reading) -> Shared:
        """Take a reading; what to tell the neighbours at this tick."""
        before = self._own
        own = self._own = Own(reading, self._s.body, None if before is None else before.tick)
        if before is None:
            self._rejoin.sense(own)
        if self._proximity is not None:
            self._proximity.sense(reading)
        if reading.wind_past:
            self._decision.prefill(reading)
        if self.decision_due:
            self._decision.record(own)
            # Who does not yet know what the group knows has nothing to say to it.
            ready = not self._rejoin.listening
            self._detected = ready and own.concentration > self._s.decision.threshold
            if self._detected:
                self._group.detect(own.t, own.concentration, own.x, own.y)
                self._decision.detect(own)
            if self._detected or (self._at_once and ready):
                self._begin(own)
            if ready and not self._begun and not self._group.started:
                self._plan = self._search.plan(own, self._group)
        group, (fusion_x, fusion_y), (h_x, h_y) = self._group, self._decision.state, self._decision.h
        shared = Shared(
            self.robot,
            own.tick,
            own.x,
            own.y,
            own.vx,
            own.vy,
            fusion_x,
            fusion_y,
            group.first_detected_at,
            group.detected_at,
            group.best,
            group.best_x,
            group.best_y,
            group.leg,
            group.leg_by,
            group.heading[0],
            group.heading[1],
            h_x,
            h_y,
            self._neighbours.relay(own.tick),
            self._controller.virtual(),
            self._decision.notes(own) if self._begun else (),
            group.best_at,
            self._decision.events(own),
            self._declaration.votes(own.tick, own.t),
            self._declaration.made,
            self._decision.word,
        )
        if self.observer is not None:
            self.observer.told(shared)
        return shared

    def act(self, heard: Iterable[Shared]) -> Drive:
        """Take the neighbours' states of this tick; the torques to drive with until the next."""
        own = self._own
        if own is None:
            raise RuntimeError("act() needs a reading first: call sense()")
        neighbours, group = self._neighbours, self._group
        arrived = list(heard)
        heard = self.validation.sift(own, arrived)
        neighbours.hear(own.tick, heard)
        # Also while it still listens: what is flooded and voted comes back to a robot that lost it by hearing it.
        self._declaration.hear(own.t, heard)
        self._decision.listen(own, heard)
        others = neighbours.others(own.tick)
        waits = self._rejoin.listening and not self._rejoin.hear(own, neighbours.fresh)
        if not waits:
            for state in heard:
                group.merge(state)
        if waits:
            self._plan = at_rest(own)
        elif group.started or self._begun or self._at_once:
            self._begin(own)
            if self.decision_due or self._plan is None:
                around = Around(neighbours.fresh, others, neighbours.numbers)
                self._decision.decide(own, group, self._detected, around)
                late = self._rejoin.joined_at is not None
                decision = self._decision
                self._declaration.judge(own.t, decision.h, decision.certainty(), late, decision.meetings)
                lost = group.lost(own.t, self._s.decision.lost_after)
                self._planner.brief(own, self._decision, group, around)
                self._plan = self._planner.plan(own, self._decision.h, lost)
            else:
                self._plan = self._planner.follow(own, self._plan)
            self._decision.advance(neighbours.fresh, self._dt)
        else:
            # The heading may have changed by what was heard in this very tick.
            self._plan = self._search.plan(own, group)
        x, y = own.x, own.y
        others += [g for g in neighbours.ghosts(own.tick) if (g[0] - x) ** 2 + (g[1] - y) ** 2 < self._near2]
        if self._proximity is not None:
            others = self._proximity.see(own, others)
        u = self._controller.control(own, neighbours.present(own.tick), others, self._plan, self._dt)
        tau_left, tau_right = wheel_torques(u[0], u[1], own, self._s.body)
        if self.guard is not None and self._proximity is not None:
            tau_left, tau_right = self.guard.permit(tau_left, tau_right, own, self._proximity.bodies)
        drive = Drive(self.robot, own.tick, tau_left, tau_right, self._declaration.made)
        if self.observer is not None:
            self.observer.acted(arrived, neighbours.fresh, self._decision, self._plan.mode, drive, begun=self._begun)
        return drive

    @property
    def rejoined(self) -> int | None:
        """The tick at which a robot that joined a running swarm had taken back what the group knows; None: it has been
        there from the start, or it still listens."""
        return self._rejoin.done_at

    def belief(self, links: tuple[int, ...], dropped: int, refused: int) -> Belief:
        """What the robot thinks after `act`, for the recorder."""
        own, plan, decision = self._own, self._plan, self._decision
        if own is None or plan is None:
            raise RuntimeError("belief() needs a tick first: call sense() and act()")
        return Belief(
            robot=self.robot,
            tick=own.tick,
            t=own.t,
            mode=plan.mode,
            has_estimate=self.estimate is not None,
            h_x=decision.h[0],
            h_y=decision.h[1],
            x_hat_x=decision.estimate.x,
            x_hat_y=decision.estimate.y,
            variance=decision.estimate.P,
            fusion_x=decision.state[0],
            fusion_y=decision.state[1],
            target_x=plan.target[0],
            target_y=plan.target[1],
            detected_at=self._group.detected_at,
            heard=tuple(s.robot for _, s in self._neighbours.fresh),
            links=links,
            dropped=dropped,
            refused=refused + self.validation.total,
        )

    def belief_map(self) -> BeliefMap | None:
        """Its map of the source, for the recorder, when one is due and there is one; it may take a while."""
        own = self._own
        if own is None or not self._begun or not own.due(self._ticks_per_map):
            return None
        return map_message(self.robot, own, self._decision)

    def _begin(self, own: Own) -> None:
        if not self._begun:
            self._begun = True
            self._plan = None  # the search is over
            self._decision.begin(own)
            if self._rejoin.joined_at is not None:
                self._decision.rejoin(own, self._neighbours.fresh)
