"""`plume-map`: where the source is, by a map of the likelihood of all robots' events (robot_agent/plume).

Rules: every robot makes one event a decision, hit or miss, from the start on, and draws every event that it hears of into
its own map, once; h^ic is the mean of the posterior. Nothing is averaged and nobody is a centre.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import exp, hypot, sqrt

from protocol.messages import NEVER, Reading, Shared
from protocol.scenario import RobotScenario
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import Around, BeliefMap, Decision, Point, Posterior
from robot_agent.kalman import Estimate
from robot_agent.plume.backtrace import WindPast
from robot_agent.plume.events import LAGS, Event, Key, pack, unpack
from robot_agent.plume.evidence import Evidence
from robot_agent.plume.flood import Flood
from robot_agent.plume.map import EventMap
from robot_agent.plume.posterior import posterior, spread

SHOWN = 2  # one cell of so many along each side is shown: colours, not sums


class PlumeMapDecision(Decision):
    """One robot's events and map."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._s, self._p = scenario, scenario.plume_map
        self._step = scenario.timing.decision
        self._ticks = round(scenario.timing.decision / scenario.timing.tick)
        self._past = WindPast(self._p, self._step)
        self._flood = Flood(scenario.robots, self._p.window, [j for j, _ in scenario.row], scenario.reaches)
        self.chart = EventMap(scenario.arena, self._p, self._step)
        self._upwind = next((n for n, lag in enumerate(LAGS) if lag >= self._p.steady), len(LAGS) - 1) + 1
        self._latest: dict[int, tuple[int, Event]] = {}  # robot -> its newest event
        self._place: tuple[int, float, float] | None = None  # tick, own position with the reading's noise taken out
        self._posterior: Posterior | None = None
        self.smelt_at = NEVER  # the newest hit that was drawn, s; times of clocks far from one's own never get there
        self._evidence = Evidence(self._p)
        self.wind: Point = (1.0, 0.0)  # unit vector, where the group's wind of late blows to
        self.state: Point = (0.0, 0.0)
        self.h: Point = (0.0, 0.0)
        self.estimate = Estimate(0.0, 0.0, scenario.decision.initial_variance)

    def prefill(self, reading: Reading) -> None:
        self._past.prefill(reading.wind_past)

    def record(self, own: Own) -> None:
        x, y = self._follow(own)
        self._past.record((own.wind_x, own.wind_y))
        k = max(0, round(own.t / self._step))
        hit = own.concentration > self._s.decision.threshold
        record = pack(self._s.robot, hit, x, y, self._past.diffusivity(), self._past.way(), self._s.arena)
        self._flood.clock(k)
        if self._flood.add((k, self._s.robot), record):
            self._learn((k, self._s.robot), record)

    def listen(self, own: Own, heard: Iterable[Shared]) -> None:
        for state in heard:
            if state.events:
                for key, record in self._flood.hear(state.robot, state.events):
                    self._learn(key, record)

    def events(self, own: Own) -> bytes:
        self._follow(own)
        return self._flood.tell(own.due(self._ticks))

    def begin(self, own: Own) -> None:
        self.h = self.state = (own.x, own.y)

    def decide(self, own: Own, group: Group, detected: bool, around: Around) -> None:
        p = self._posterior = posterior(self.chart)
        self.h = self.state = (p.x, p.y)
        self.estimate = Estimate(p.x, p.y, 0.5 * (p.xx + p.yy))
        self._mean_wind()

    def posterior(self) -> Posterior | None:
        return self._posterior

    def certainty(self) -> float | None:
        return spread(self._posterior) if self._posterior is not None else None

    def meetings(self, since: float, place: Point) -> int:
        return self._evidence.meetings(since / self._step, *place)

    def belief_map(self) -> BeliefMap | None:
        if self._posterior is None:
            return None
        chart = self.chart
        xs, ys = range(0, chart.nx, SHOWN), range(0, chart.ny, SHOWN)
        rows = chart.window(xs, ys)
        top, half = max(map(max, rows)), 0.5 * chart.scale()
        grid = bytes(round(255 * exp(half * (m - top))) for column in zip(*rows, strict=True) for m in column)
        return chart.x0, chart.y0, SHOWN * chart.cell, len(ys), grid

    def _learn(self, key: Key, record: bytes) -> None:
        event = unpack(record, self._s.arena)
        self.chart.learn(key[0], event)
        if event.hit:
            self.smelt_at = max(self.smelt_at, key[0] * self._step)
            self._evidence.add(key[0], event)
        latest = self._latest.get(event.robot)
        if latest is None or latest[0] < key[0]:
            self._latest[event.robot] = (key[0], event)

    def company(self) -> frozenset[int]:
        """The robots whose events of late have come, oneself included: those that see the same map."""
        newest, window = self.chart.newest, self._p.window
        return frozenset(robot for robot, (k, _) in self._latest.items() if newest - k < window)

    def _mean_wind(self) -> None:
        """Direction of the mean of the newest events' ways."""
        x = y = 0.0
        for robot in sorted(self.company()):
            _, event = self._latest[robot]
            _, bx, by = event.way[self._upwind]
            x, y = x + event.x - bx, y + event.y - by
        size = hypot(x, y)
        if size > 0.0:
            self.wind = (x / size, y / size)

    def _follow(self, own: Own) -> Point:
        """Own position: the wheels' speed added up, drawn towards every reading, so that a reading's noise averages out."""
        if self._place is None or own.tick - self._place[0] > self._ticks:  # where it was before it hung says nothing
            self._place = (own.tick, own.x, own.y)
        elif self._place[0] != own.tick:
            tick, x, y = self._place
            dt, share = (own.tick - tick) * self._s.timing.tick, self._p.smooth
            x, y = x + dt * own.vx, y + dt * own.vy
            self._place = (own.tick, x + share * (own.x - x), y + share * (own.y - y))
        return self._place[1], self._place[2]


def deviation_along(p: Posterior, ux: float, uy: float) -> float:
    """Standard deviation of the posterior along a unit vector, m."""
    return sqrt(max(0.0, p.xx * ux * ux + 2.0 * p.xy * ux * uy + p.yy * uy * uy))
