"""A robot that joins a running swarm takes back what the group knows."""

from judging_helpers import DT, reading, told, view

from robot_agent.agent import Agent
from robot_agent.measurement import WindMemory

FIRST = 1207  # not an instant of decision


def joined(*states, **values):
    agent = Agent(view(topology="all", **values))
    agent.sense(reading(FIRST))
    agent.act([told(j, FIRST, x, y, fusion_x=f[0], fusion_y=f[1]) for j, x, y, f in states])
    return agent


def test_fusion_state_and_decision_come_from_the_neighbours_within_one_tick_of_hearing_them():
    agent = joined((1, 60.0, 5.0, (40.0, 2.0)), (2, 62.0, 7.0, (41.0, 3.0)), (3, 64.0, 3.0, (39.0, 1.0)))
    assert agent.rejoined == FIRST
    state = agent.sense(reading(FIRST + 1))
    assert state.first_detected_at == 0.0
    assert abs(state.fusion_x - 40.0) < 0.5
    assert abs(state.fusion_y - 2.0) < 0.5
    assert agent.estimate is not None


def test_one_liar_of_three_neighbours_does_not_decide_what_is_taken_back():
    agent = joined((1, 60.0, 5.0, (40.0, 2.0)), (2, 62.0, 7.0, (41.0, 3.0)), (3, 64.0, 3.0, (150.0, -90.0)),
                   fusion__kind="resilient")  # fmt: skip
    x, y = agent._decision.state
    assert 40.0 <= x <= 41.0
    assert 2.0 <= y <= 3.0


def test_until_it_has_heard_somebody_it_stands_still_and_says_nothing_of_the_odour():
    agent = Agent(view(topology="all"))
    for k in range(20):  # timing.listen
        state = agent.sense(reading(FIRST + k, ppt=5000.0))
        assert state.first_detected_at < 0.0
        assert state.search_leg == -1
        drive = agent.act([])
        assert (drive.tau_left, drive.tau_right) == (0.0, 0.0)
        assert agent.rejoined is None


def test_where_nobody_is_to_be_heard_it_begins_by_itself_after_a_while():
    agent = Agent(view(topology="all"))
    for k in range(60):
        agent.sense(reading(FIRST + k, ppt=5000.0))
        agent.act([])
    assert agent.rejoined == FIRST + 20
    assert agent.estimate is not None


def test_while_the_others_search_it_takes_their_heading_and_proposes_none():
    agent = Agent(view(topology="all"))
    nobody = {"first_detected_at": -1.0, "detected_at": -1.0, "best_concentration": 0.0, "best_at": -1.0}
    first = agent.sense(reading(FIRST))
    agent.act([told(2, FIRST, search_leg=3, search_by=2, search_x=0.0, search_y=-1.0, **nobody)])
    second = agent.sense(reading(FIRST + 1))
    assert first.search_leg == -1
    assert (second.search_leg, second.search_by, second.search_y) == (3, 2, -1.0)
    assert agent.rejoined == FIRST
    assert agent.estimate is None


def test_it_measures_only_when_its_wind_memory_goes_back_far_enough():
    """At x = 50 m and 1 m/s the odour may be 50 s old; a memory of 10 s would put the source 5 m upwind of the robot."""
    agent = joined((1, 60.0, 5.0, (10.0, 0.0)), (2, 62.0, 7.0, (10.0, 0.0)))
    measured_at = None
    for k in range(FIRST + 1, FIRST + 1400):
        agent.sense(reading(k, ppt=900.0))
        neighbours = [told(j, k, fusion_x=10.0, fusion_y=0.0) for j in (1, 2)]
        agent.act(neighbours)
        if agent._decision.input is None:
            assert abs(agent._decision.state[0] - 10.0) < 0.5  # it lives on what the neighbours know
        elif measured_at is None:
            measured_at = k
    assert measured_at is not None
    assert 49.0 <= (measured_at - FIRST) * DT <= 52.0


def test_wind_memory_reaches_far_enough_when_it_is_full_or_its_end_lies_outside_the_arena():
    arena = view().arena
    memory = WindMemory(100)
    assert not memory.reaches(30.0, 0.0, 1.0, arena)
    for _ in range(29):
        memory.record((1.0, 0.0))
    assert not memory.reaches(30.0, 0.0, 1.0, arena)
    memory.record((1.0, 0.0))
    assert memory.reaches(30.0, 0.0, 1.0, arena)
    calm = WindMemory(5)
    for _ in range(5):
        calm.record((0.01, 0.0))
    assert calm.reaches(30.0, 0.0, 1.0, arena)


def test_a_robot_that_was_there_from_the_start_never_rejoins():
    agent = Agent(view(topology="all"))
    for k in range(30):
        agent.sense(reading(k, ppt=900.0, **({"wind_past": ((1.0, 0.0),) * 100} if k == 0 else {})))
        agent.act([])
    assert agent.rejoined is None
    assert agent._decision.input is not None
