"""A new algorithm is one class and one line: the example of docs/add-an-algorithm.md runs on a whole swarm."""

from collections.abc import Sequence

import pytest

from deploy.memory_run import run_in_memory
from protocol.scenario import RobotScenario
from protocol.scenario.load import load_scenario
from robot_agent.algorithms import ALGORITHMS, Algorithm
from robot_agent.control.repulsion import keep_clear
from robot_agent.decision.dda import DistributedDecision
from robot_agent.hand import Own, top_acceleration
from robot_agent.interfaces import SEARCH, Controller, Fresh, Plan, Point
from robot_agent.neighbours import Placed
from robot_agent.planning.trace import TracePlanner


class StraightControl(Controller):
    """u_i = p_i - x_i - 2 v_i, and (3.35) to keep clear."""

    def __init__(self, scenario: RobotScenario) -> None:
        self._potential = scenario.repulsion
        self._top = top_acceleration(scenario.body)

    def control(self, own: Own, fresh: Fresh, others: Sequence[Placed], plan: Plan, dt: float) -> Point:
        if plan.mode == SEARCH:  # the search gives a velocity, not a place
            u = (plan.v_c[0] - own.vx, plan.v_c[1] - own.vy)
        else:
            u = (plan.target[0] - own.x - 2.0 * own.vx, plan.target[1] - own.y - 2.0 * own.vy)
        return keep_clear(u, own, others, self._potential, self._top)


@pytest.mark.parametrize("topology", ["ring", "line"])
def test_the_example_of_the_documentation_finds_the_source(monkeypatch, topology):
    line = Algorithm("DDA with a damped pull", DistributedDecision, TracePlanner, StraightControl)
    monkeypatch.setitem(ALGORITHMS, "straight", line)
    values = {"algorithm": "straight", "topology": topology, "start.x": 60.0, "start.y": -6.0, "max_time": 300.0}
    scenario = load_scenario(None, overrides=[(k, v, "test") for k, v in values.items()], algorithms=ALGORITHMS)
    outcome = run_in_memory(scenario)
    assert outcome.found
    assert outcome.min_pair_distance > 0.4
