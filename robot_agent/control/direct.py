"""The velocity of a particle swarm (2.1), or any other that a plan holds, taken up by the hand.

u_i = k (v_c - v_i): the double integrator (1.7) follows the velocity v_c of the plan with the gain k (`pso.gain`); (3.35)
is added when somebody is within `pso.clearance`: particle swarms have no collision avoidance of their own.
"""

from __future__ import annotations

from msgspec.structs import replace

from protocol.scenario import RobotScenario
from robot_agent.control.velocity import VelocityControl


class DirectControl(VelocityControl):
    """Takes the velocity of the plan, with the gain and the clearance of a particle swarm."""

    def __init__(self, scenario: RobotScenario) -> None:
        super().__init__(scenario)
        self._gain = scenario.pso.gain
        self._potential = replace(scenario.repulsion, d=scenario.pso.clearance)
