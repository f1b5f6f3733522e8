"""Robots that fell silent: kept clear of where they stand, and nothing else."""

from judging_helpers import reading, told, view

from robot_agent.agent import Agent
from robot_agent.neighbours import Neighbours


def hear(neighbours, tick, *states):
    neighbours.hear(tick, states)
    return neighbours.others(tick)


def test_a_neighbour_that_falls_silent_stands_where_it_would_have_come_to_rest():
    neighbours = Neighbours(view(topology="all"))
    state = told(1, 0, x=60.0, y=5.0, vx=0.6, vy=-0.8)
    assert len(hear(neighbours, 0, state)) == 1
    assert neighbours.ghosts(0) == []
    assert hear(neighbours, 400) == []
    ((x, y, vx, vy),) = neighbours.ghosts(400)
    assert (vx, vy) == (0.0, 0.0)
    way = 1.0 / (2 * 0.8 * 0.079 / 0.07)  # v^2 / (2 a) with all that the wheels give
    assert abs(x - (60.0 + 0.6 * way)) < 1e-12
    assert abs(y - (5.0 - 0.8 * way)) < 1e-12


def test_silent_robots_are_in_no_consensus_sum_and_no_decision():
    neighbours = Neighbours(view(topology="all"))
    hear(neighbours, 0, told(1, 0), told(2, 0))
    assert len(hear(neighbours, 20, told(2, 20))) == 1
    assert [s.robot for _, s in neighbours.fresh] == [2]
    assert neighbours.numbers == [2]
    assert len(neighbours.ghosts(20)) == 1


def test_a_silent_robot_that_is_heard_again_is_no_ghost():
    neighbours = Neighbours(view(topology="all"))
    hear(neighbours, 0, told(1, 0))
    hear(neighbours, 100)
    assert neighbours.ghosts(100)
    hear(neighbours, 101, told(1, 101))
    assert neighbours.ghosts(101) == []


def test_silent_robots_are_forgotten_in_time():
    neighbours = Neighbours(view(topology="all", control__remember=30.0))
    hear(neighbours, 0, told(1, 0))
    hear(neighbours, 600)
    assert len(neighbours.ghosts(600)) == 1
    hear(neighbours, 601)
    assert neighbours.ghosts(601) == []
    never = Neighbours(view(topology="all", control__remember=0.0))
    hear(never, 0, told(1, 0))
    hear(never, 100)
    assert never.ghosts(100) == []


def test_a_robot_that_was_only_passed_on_is_silent_when_nothing_new_of_it_comes():
    neighbours = Neighbours(view(topology="line"))  # robot 0 hears robot 1
    for k in range(0, 41, 4):
        hear(neighbours, k, told(1, k, relayed=((2, k, 50.0, 9.0, 0.0, 0.0),)))
        assert neighbours.ghosts(k) == []
    for k in range(41, 120):
        others = hear(neighbours, k, told(1, k))
        silent = k - 40 > 40  # control.relay_age
        assert len(others) == (1 if silent else 2)
        assert neighbours.ghosts(k) == ([(50.0, 9.0, 0.0, 0.0)] if silent else [])


def test_a_robot_that_comes_later_learns_of_the_silent_from_its_neighbours():
    for topology in ("line", "all"):
        teller = Neighbours(view(1, topology=topology))
        hear(teller, 0, told(2, 0, x=70.0))
        hear(teller, 200, told(0, 200))
        records = teller.relay(200)
        assert [r for r in records if r[0] == 2] == [(2, 0, 70.0, 5.0, 0.3, 0.0)]
        newcomer = Neighbours(view(0, topology=topology))
        hear(newcomer, 200, told(1, 200, relayed=records))
        ((x, _, vx, _),) = newcomer.ghosts(200)
        assert 70.0 < x < 70.1
        assert vx == 0.0


def test_where_everybody_is_heard_nothing_is_passed_on():
    neighbours = Neighbours(view(topology="all"))
    for k in range(20):
        assert neighbours.relay(k) == ()
        hear(neighbours, k, *(told(j, k) for j in range(1, 5)))


def test_a_silent_robot_far_away_pulls_nobody_even_under_the_potential_that_draws_together():
    """(3.35) pushes apart below d = 4 m and draws together beyond: only the push is wanted of one that is silent."""
    drives = {}
    for x in (52.0, 55.2, 90.0):
        agent = Agent(view(topology="all", algorithm="simple"))
        agent.sense(reading(0))
        agent.act([told(1, 0, x=x, y=0.0, vx=0.0, best_x=60.0, best_y=0.0)])
        for k in range(1, 12):
            agent.sense(reading(k))
            drive = agent.act([])
        assert agent._neighbours.ghosts(11) == [(x, 0.0, 0.0, 0.0)]
        drives[x] = drive
    assert drives[55.2] == drives[90.0]
    assert drives[52.0] != drives[90.0]
