"""The distributed decision algorithm (DDA).

Thesis chapter 3, Algorithm 1: measurement (3.9), Kalman filter (3.11)-(3.17), fusion (3.26), and the decision
(3.31)  h^ic = c_1 y_i + c_2 p_hat_i  with the oscillation centre p_hat of (2.4).
"""

from __future__ import annotations

from protocol.messages import Reading
from protocol.randomness import rng_for
from protocol.scenario import RobotScenario
from robot_agent import fusion, kalman
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import Around, Decision, Fresh, Point
from robot_agent.measurement import WindMemory, measure
from robot_agent.rejoin import begun, middle
from robot_agent.words import Words


class DistributedDecision(Decision):
    """One robot's part of the DDA."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._s = scenario
        self._winds = WindMemory(scenario.decision.memory)
        self.recall = scenario.decision.recall
        self.input: Point | None = None
        self.fuses = True
        judges = scenario.fusion.kind == "resilient" and scenario.fusion.judge == "words"
        self._words = Words(scenario) if judges else None
        self._R = scenario.decision.sigma2
        self._ticks_per_decision = round(scenario.timing.decision / scenario.timing.tick)
        self._short_memory = False  # after it joined late
        self._k = 0  # decisions since the start of the mission
        self.state: Point = (0.0, 0.0)
        self.h: Point = (0.0, 0.0)
        self.estimate = kalman.Estimate(0.0, 0.0, scenario.decision.initial_variance)

    def prefill(self, reading: Reading) -> None:
        """Take the wind that was recorded before the start."""
        self._winds.prefill(reading.wind_past)

    def record(self, own: Own) -> None:
        self._winds.record((own.wind_x, own.wind_y))
        self._k += 1
        if self._s.decision.noise == "model":
            self._R = kalman.model_noise(self._s.decision.sigma2, own.t)
        else:
            self._R = kalman.printed_noise(self._R, own.t)

    def begin(self, own: Own) -> None:
        self.state = self.h = (own.x, own.y)
        self.estimate = kalman.Estimate(own.x, own.y, self._s.decision.initial_variance)

    def rejoin(self, own: Own, fresh: Fresh) -> None:
        """y_i and h^ic from the neighbours; x_hat_i is as sure of y_i as of one measurement; no measurement of its own
        before the wind memory goes back far enough, until then lambda_i = 0."""
        self._short_memory = True
        for k in range(1, own.tick // self._ticks_per_decision):
            if self._s.decision.noise == "printed":
                self._R = kalman.printed_noise(self._R, k * self._s.timing.decision)
        self._k = own.tick // self._ticks_per_decision + 1  # as if it had counted from the start: new draws
        if known := begun(fresh):
            self.state = middle((s.fusion_x, s.fusion_y) for s in known)
            self.h = middle((s.h_x, s.h_y) for s in known)
            self.estimate = kalman.Estimate(*self.state, min(self._s.decision.initial_variance, self._R))

    def decide(self, own: Own, group: Group, detected: bool, around: Around) -> None:
        d = self._s.decision
        z: Point | None = None
        if detected and self._can_measure(own):
            sums = self._winds.displacements(self._s.timing.decision)
            z = measure(own.x, own.y, sums, d, self._s.arena, (self.estimate.x, self.estimate.y))
        self.estimate = kalman.update(kalman.predict(self.estimate, d.process_noise), z, self._R)
        measured = z is not None or self._s.fusion.input == "always"
        self.input = (self.estimate.x, self.estimate.y) if measured else None
        if self._words is not None:
            if measured:
                self.word = (self.estimate.x, self.estimate.y, own.t)
            self.input = self._words.input(own.t, self.word, around.fresh, self.state)
        p_hat = self._oscillation_centre(group)
        c1, c2 = d.c1, 1.0 - d.c1
        self.h = (c1 * self.state[0] + c2 * p_hat[0], c1 * self.state[1] + c2 * p_hat[1])
        if d.lost == "smell" and group.lost(own.t, d.lost_after):
            self.h = (group.best_x, group.best_y)  # no measurement speaks for y_i any more

    def advance(self, fresh: Fresh, dt: float) -> None:
        # A neighbour that has not heard of the first detection has no fusion state yet.
        others = [(a_ij, s.fusion_x, s.fusion_y) for a_ij, s in fresh if s.first_detected_at >= 0.0]
        self.state = fusion.step(self.state, others, self.input, self._s.fusion, self._s.max_degree, dt)

    def _can_measure(self, own: Own) -> bool:
        if self._short_memory:
            self._short_memory = not self._winds.reaches(own.x, own.y, self._s.timing.decision, self._s.arena)
        return not self._short_memory

    def _oscillation_centre(self, group: Group) -> Point:
        """p_hat_i = (alpha_1 x_l + alpha_2 x_g) / (alpha_1 + alpha_2), (2.4); x_g alone before an own detection."""
        x_g = (group.best_x, group.best_y)
        x_l = group.own_best()
        if x_l is None:
            return x_g
        draws = rng_for(self._s.seed, "pso", self._s.robot, self._k)
        alpha1 = draws.uniform()
        alpha2 = 1.0 - draws.uniform()  # in (0, 1]: the sum is never 0
        total = alpha1 + alpha2
        return (alpha1 * x_l.x + alpha2 * x_g[0]) / total, (alpha1 * x_l.y + alpha2 * x_g[1]) / total
