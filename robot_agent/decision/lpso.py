"""Learning PSO (LPSO), constructed from its abstract.

[Lu & Luo 2011] could not be read but for its abstract. SOURCED there: each robot builds and updates a map of the probability
of the source from the concentration magnitude, the wind and the swarm's information; the new position is generated from the
map; a consensus algorithm, here (2.7), moves the robot there. INFERRED: everything below. Do not take it for a replication.

Every robot reports once in `report` seconds what it smells, where, and the way of the air that it smells, summed up from its
own record of the wind at four lags. Reports travel over the graph, the newest of each robot, so that each robot has its own
map of all reports (`robot_agent.source_map`). A report of odour counts C / (C + threshold): a faint one says less. p_i is
taken from the map every `sampling` seconds: its mean, its maximum, or a draw.
"""

from __future__ import annotations

from math import exp

from protocol.messages import Reading
from protocol.randomness import rng_for
from protocol.scenario import RobotScenario
from robot_agent.decision.gossip import Gossip, Record
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import Around, Decision, Fresh, Point
from robot_agent.kalman import Estimate
from robot_agent.measurement import WindMemory
from robot_agent.particle import Sampling
from robot_agent.source_map import Place, SourceMap

STRETCHES = 4  # of the way of the air in a report
WIDTH = 5 + 3 * STRETCHES  # robot, time, concentration, x, y, and (lag, x, y) at the end of every stretch


class LpsoDecision(Decision):
    """h^ic from the map of all reports."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._s = scenario
        self._p = scenario.lpso
        self._winds = WindMemory(scenario.decision.memory)
        self._map = SourceMap(scenario.arena, scenario.lpso)
        self._reports = Gossip(scenario, WIDTH)
        self._reporting = Sampling(scenario.lpso.report, scenario.timing.decision)
        self._sampling = Sampling(scenario.lpso.sampling, scenario.timing.decision)
        self._faded_at = 0.0
        self._decided((0.0, 0.0), 0.0)

    def prefill(self, reading: Reading) -> None:
        self._winds.prefill(reading.wind_past)

    def record(self, own: Own) -> None:
        self._winds.record((own.wind_x, own.wind_y))

    def begin(self, own: Own) -> None:
        self._faded_at = own.t
        self._decided((own.x, own.y), self._s.decision.initial_variance)

    def _decided(self, h: Point, variance: float) -> None:
        # The maps are not fused, the reports are shared: what travels as the fusion state is the decision itself.
        self.h = self.state = h
        self.estimate = Estimate(*h, variance)

    def decide(self, own: Own, group: Group, detected: bool, around: Around) -> None:
        self.advance(around.fresh, 0.0)
        if self._reporting.due(own.t):
            report = self._report(own)
            if self._reports.offer(report):
                self._learn(report)
        if not self._sampling.due(own.t):
            return
        self._map.forget(exp((self._faded_at - own.t) / self._p.memory))
        self._faded_at = own.t
        h, variance = self._map.mean()
        if self._p.choice == "best":
            h = self._map.best()
        elif self._p.choice == "draw":
            h = self._map.drawn(rng_for(self._s.seed, "lpso", self._s.robot, own.tick).uniform())
        self._decided(h, variance)

    def advance(self, fresh: Fresh, dt: float) -> None:
        for report in self._reports.hear(fresh):
            self._learn(report)

    def notes(self, own: Own) -> tuple[float, ...]:
        return self._reports.notes(own)

    def _report(self, own: Own) -> Record:
        """What this robot has to say now."""
        step = self._s.timing.decision
        sums = self._winds.displacements(step)
        way: list[float] = []
        for m in range(1, STRETCHES + 1):
            k = len(sums) * m // STRETCHES - 1
            dx, dy = sums[k] if k >= 0 else (0.0, 0.0)
            way += [(k + 1) * step, own.x - dx, own.y - dy]
        return (float(self._s.robot), own.t, own.concentration, own.x, own.y, *way)

    def _learn(self, report: Record) -> None:
        C, threshold = report[2], self._s.decision.threshold
        line: list[Place] = [(0.0, report[3], report[4])]
        line += [(report[n], report[n + 1], report[n + 2]) for n in range(5, WIDTH, 3)]
        smelt = C > threshold
        self._map.learn(line, smelt, C / (C + threshold) if smelt else 1.0)
