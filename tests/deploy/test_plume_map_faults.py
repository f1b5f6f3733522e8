"""plume-map and its declaration in a laboratory of faults: what is lost comes again, who was away takes it back."""

import pytest
from swarm_helpers import near_the_plume

from deploy.memory_run import MemorySwarm
from protocol.messages import Outcome
from world_server.outcome import outcome

PARTS = [[0, 1], [2, 3, 4]]


def swarm_of(**values: object) -> MemorySwarm:
    near = {"source__x": 35.0, "start__x": 50.0, "start__y": -8.0, "max_time": 220.0, "declaration__stop": "declared"}
    return MemorySwarm(near_the_plume(**{"algorithm": "plume-map", "topology": "ring", **near, **values}))


def played(swarm: MemorySwarm) -> Outcome:
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
    return outcome(swarm.session, "memory", 1.0, swarm.bus.counters)


@pytest.mark.parametrize(
    "values",
    [
        {"faults": [{"kind": "loss", "probability": 0.3}]},
        {"faults": [{"kind": "loss", "probability": 0.3}], "topology": "directed-ring"},
        {"topology": [{"at": 0, "name": "line"}, {"at": 10, "name": "line", "range": 0.01}], "graph_options__period": 20.0},
        {"faults": [{"kind": "crash", "robot": 2, "at": 20.0}]},
        {"faults": [{"kind": "crash", "robot": 2, "at": 20.0, "restart": 10.0}]},
        {"faults": [{"kind": "hang", "robot": 2, "at": 20.0, "until": 45.0}], "topology": "line"},
        {"faults": [{"kind": "partition", "at": 20.0, "until": 60.0, "groups": PARTS}]},
        {"faults": [{"kind": "clock-skew", "robot": 1, "offset": 3.0, "at": 5.0}]},
    ],
    ids=["loss", "loss one way", "switching", "crash", "restart", "hang", "partition", "clock"],
)
def test_the_place_is_declared_and_nobody_who_is_honest_is_refused(values):
    swarm = swarm_of(**values)
    ended = played(swarm)
    assert ended.ended == "declared"
    assert not ended.false_declaration
    assert ended.messages["refused"] == 0
    assert ended.min_pair_distance >= 0.6
    made = {swarm.robots[i].session.agent._declaration.made for i in swarm.session.world.live}
    assert made == {swarm.session.declarations.common}


def test_a_robot_that_was_started_again_is_told_the_events_of_the_window():
    swarm = swarm_of(max_time=40.0, faults=[{"kind": "crash", "robot": 2, "at": 20.0, "restart": 5.0}])
    played(swarm)
    mine, other = (swarm.robots[i].session.agent for i in (2, 0))
    assert mine.rejoined is not None
    assert mine._decision._flood._known == other._decision._flood._known
    assert mine._decision.company() == other._decision.company() == frozenset(range(5))
