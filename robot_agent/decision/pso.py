"""Particle swarm optimisation as a decision: the oscillation centre, without and with charge.

Thesis (2.4) p_i = (alpha_1 x_l + alpha_2 x_g) / (alpha_1 + alpha_2), f the concentration: x_l is where this robot met the
highest one, x_g where anybody did, which travels from neighbour to neighbour (`robot_agent.group`). A robot that has not
detected yet has no x_l but where it is, so that (2.3) draws it to x_g alone.

Charged [Blackwell 2003, Jatmiko 2007]: v(k+1) = omega v + alpha_1 (x_l - x) + alpha_2 (x_g - x) + a_i, which is (2.5) with
the centre moved by a_i / (alpha_1 + alpha_2); a_i is the Coulomb push of the other charged robots, wherever they are known
to be. The constriction chi is in omega, alpha_1 and alpha_2, so that a_i stands outside of it as in [Blackwell 2003].
"""

from __future__ import annotations

from protocol.scenario import RobotScenario
from robot_agent import particle
from robot_agent.group import Group
from robot_agent.hand import Own
from robot_agent.interfaces import Around, Decision, Point
from robot_agent.kalman import Estimate
from robot_agent.particle import Sampling


class PsoDecision(Decision):
    """h^ic = p_i of (2.4), anew every `period` seconds and held in between."""

    def __init__(self, scenario: RobotScenario, period: float, charged: bool = False) -> None:
        self._s = scenario
        self._swarm: particle.Swarm = scenario.cpso if charged else scenario.pso
        self._charged = charged and particle.is_charged(scenario.robot)
        self._sampling = Sampling(period, scenario.timing.decision)
        self.recall = scenario.pso.recall
        self._decided((0.0, 0.0))

    def begin(self, own: Own) -> None:
        self._decided((own.x, own.y))

    def _decided(self, h: Point) -> None:
        # Nothing is fused or filtered: what travels is the decision itself, and it has no variance.
        self.h = self.state = h
        self.estimate = Estimate(*h, 0.0)

    def decide(self, own: Own, group: Group, detected: bool, around: Around) -> None:
        if not self._sampling.due(own.t):
            return
        alpha = particle.coefficients(self._s.seed, self._s.robot, own.tick, self._swarm)
        mine = group.own_best()
        x_l = (mine.x, mine.y) if mine else (own.x, own.y)
        p = particle.centre(x_l, (group.best_x, group.best_y), alpha)
        if self._charged:
            push, total = self._push(own, around), alpha.total
            p = (p[0] + push[0] / total[0], p[1] + push[1] / total[1])
        self._decided(particle.within(p, self._s.arena))

    def _push(self, own: Own, around: Around) -> Point:
        c = self._s.cpso
        charged = [
            (x, y) for j, (x, y, _, _) in zip(around.numbers, around.others, strict=True) if particle.is_charged(j)
        ]
        return particle.coulomb((own.x, own.y), charged, c.charge, c.core, c.reach)


def pso(scenario: RobotScenario) -> PsoDecision:
    """For the direct control of (2.1)-(2.3)."""
    return PsoDecision(scenario, scenario.pso.sampling)


def cpso(scenario: RobotScenario) -> PsoDecision:
    """For the direct control, half of the robots charged."""
    return PsoDecision(scenario, scenario.pso.sampling, charged=True)


def pso_centre(scenario: RobotScenario) -> PsoDecision:
    """For a control law that follows p_i(k), Figure 2.2."""
    return PsoDecision(scenario, scenario.consensus.sampling)


def cpso_centre(scenario: RobotScenario) -> PsoDecision:
    """For a control law that follows p_i(k), half of the robots charged."""
    return PsoDecision(scenario, scenario.consensus.sampling, charged=True)


def wind_user(scenario: RobotScenario) -> PsoDecision:
    """For the direct control with wind utilisation."""
    return PsoDecision(scenario, scenario.wui.sampling, charged=scenario.wui.charged)
