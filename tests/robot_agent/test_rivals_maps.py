"""The constructed rivals: shared records, the Gaussian of the best places, the source map, the nearest neighbours."""

import math
from itertools import combinations, pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deploy.memory_run import MemorySwarm, run_in_memory
from protocol.messages import MAX_RECORDS, Reading, Shared
from protocol.scenario import robot_view
from protocol.scenario.laws import Lpso
from protocol.scenario.load import load_scenario
from protocol.scenario.sections import Arena
from robot_agent.control.ccs import nearest
from robot_agent.decision.gossip import Gossip
from robot_agent.decision.ppso_im import draw, fit
from robot_agent.hand import Own
from robot_agent.source_map import SourceMap

RIVALS = ["ppso-im", "lpso", "ccs-like"]
ARENA = Arena()
EAST = [(0.0, 90.0, 0.0), (50.0, 40.0, 0.0), (100.0, -10.0, 0.0)]  # where the air came from, wind 1 m/s along x
weighed = st.lists(
    st.tuples(st.floats(1.0, 1e4), st.tuples(st.floats(0, 100), st.floats(-50, 50))), min_size=1, max_size=6
)


def scenario(**values):
    chosen = {"start.x": 60.0, "start.y": -6.0, "plume.warm_up": 120.0, "max_time": 8.0}
    chosen |= {name.replace("__", "."): value for name, value in values.items()}
    return load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])


def own_at(x=0.0, y=0.0, tick=0):
    s = scenario()
    return Own(Reading(0, tick, 0.0, x - s.body.hand, y, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0), s.body)


def state_of(robot, x=0.0, y=0.0, notes=()):
    return Shared(
        robot, 0, x, y, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 0.0, 0.0, 0.0, notes=tuple(notes)
    )


# Records


def test_the_newest_record_of_a_robot_wins_in_whatever_order_records_are_heard():
    view = robot_view(scenario(), 0)
    old, new = (3.0, 1.0, 7.0), (3.0, 2.0, 8.0)
    for order in ([old, new], [new, old], [new, new, old]):
        gossip = Gossip(view, 3)
        for record in order:
            list(gossip.hear([(1.0, state_of(1, notes=record))]))
        assert gossip.records() == [new]


def test_half_a_record_is_not_taken():
    gossip = Gossip(robot_view(scenario(), 0), 3)
    heard = list(gossip.hear([(1.0, state_of(1, notes=(3.0, 1.0, 7.0, 4.0, 2.0)))]))
    assert heard == gossip.records() == [(3.0, 1.0, 7.0)]


def test_records_are_told_at_decisions_only_and_never_more_than_a_message_holds():
    gossip = Gossip(robot_view(scenario(), 0), 6)
    for robot in range(900):
        gossip.offer((float(robot), float(robot), 0.0, 0.0, 0.0, 0.0))
    assert gossip.notes(own_at(tick=1)) == ()
    told = gossip.notes(own_at(tick=20))
    assert len(told) <= MAX_RECORDS
    assert told[0] == 899.0  # the newest ones


@pytest.mark.parametrize(("topology", "hops"), [("line", 4), ("ring", 2), ("all", 1)])
def test_a_report_reaches_everybody_one_edge_a_decision(topology, hops):
    """Robot 0 of a swarm meets the strongest odour; the others have its record after as many seconds as hops."""
    swarm = MemorySwarm(scenario(algorithm="ppso-im", topology=topology, max_time=20.0))
    swarm.start()
    swarm.tick()
    agents = [robot.session.agent for robot in swarm.robots.values()]
    for agent in agents:
        agent._group.detect(0.0, 700.0, 60.0, 0.0)
    agents[0]._group.detect(0.0, 99999.0, 61.0, 1.0)
    agents[0]._decision._bests.offer((0.0, 1e9, 99999.0, 0.0, 61.0, 1.0))

    def informed():
        return sum((0.0, 1e9, 99999.0, 0.0, 61.0, 1.0) in agent._decision._bests.records() for agent in agents)

    counts = []
    for _ in range(6):
        for _ in range(20):
            swarm.tick()
        counts.append(informed())
    assert counts[hops] == 5
    assert counts[0] < 5 or hops == 1


# The Gaussian of the best places


@settings(max_examples=40)
@given(points=weighed, stretch=st.floats(0, 6), floor=st.floats(0.5, 10))
def test_fit_is_the_weighted_mean_and_covariance(points, stretch, floor):
    (x, y), (xx, xy, yy) = fit(points, stretch, floor)
    w = np.array([p[0] for p in points])
    at = np.array([p[1] for p in points])
    mean = np.average(at, axis=0, weights=w)
    off = at - mean
    covariance = stretch**2 * (off.T * w) @ off / w.sum() + floor**2 * np.eye(2)
    assert (x, y) == pytest.approx(mean, abs=1e-6)
    assert [xx, xy, yy] == pytest.approx([covariance[0, 0], covariance[0, 1], covariance[1, 1]], rel=1e-6, abs=1e-4)
    assert np.linalg.eigvalsh([[xx, xy], [xy, yy]]).min() >= floor**2 * (1 - 1e-6)


@settings(max_examples=40)
@given(points=weighed)
def test_a_draw_is_the_cholesky_factor_times_the_normal_draws(points):
    gaussian = fit(points, 2.0, 1.0)
    (x, y), (xx, xy, yy) = gaussian
    columns = np.array([draw(gaussian, 1.0, 0.0), draw(gaussian, 0.0, 1.0)]).T - [[x], [y]]
    assert columns @ columns.T == pytest.approx(np.array([[xx, xy], [xy, yy]]), rel=1e-6, abs=1e-4)


# The source map


def brute(p, lines):
    """The same posterior cell by cell for straight lines, with no limit on how far from them."""
    source_map = SourceMap(ARENA, p)
    log = np.zeros(len(source_map.log))
    for n in range(len(log)):
        cx, cy = source_map.centre(n)
        for line, smelt in lines:
            for (l1, x1, y1), (l2, x2, y2) in pairwise(line):
                run = np.array([x2 - x1, y2 - y1])
                by_x = abs(run[0]) >= abs(run[1])
                part = (cx - x1) / run[0] if by_x else (cy - y1) / run[1]
                if not 0.0 <= part < 1.0:
                    continue
                cosine = max(abs(run)) / math.hypot(*run)
                d = ((cy - y1 - part * run[1]) if by_x else (cx - x1 - part * run[0])) * cosine
                s2 = p.width**2 + p.spread**2 * (l1 + part * (l2 - l1))
                g = p.hit * math.exp(-d * d / (2 * s2))
                log[n] += math.log((p.false + g) / p.false) if smelt else math.log((1 - p.false - g) / (1 - p.false))
    return log


@pytest.mark.parametrize("angle", [0.0, 0.5, 1.2, 2.9, -2.0])
def test_the_map_is_bayes_rule_cell_by_cell(angle):
    p = Lpso(cell=4.0)
    c, s = math.cos(angle), math.sin(angle)
    line = [(lag, 50.7 + lag * c, 1.0 + lag * s) for lag in (0.0, 30.0, 60.0)]
    source_map = SourceMap(ARENA, p)
    source_map.learn(line, True)
    source_map.learn(line[:2], False)
    # What is beyond the reach of 3 s is left out: log(1 + hit/false exp(-4.5)) at most.
    assert source_map.log == pytest.approx(brute(p, [(line, True), (line[:2], False)]), abs=0.12)


def test_odour_upwind_of_which_the_air_is_clean_comes_from_between():
    """Robots smell odour at x = 90 and 60 and clean air at x = 30: the source is between 30 and 60, on the line."""
    source_map = SourceMap(ARENA, Lpso())
    for _ in range(10):
        for x, smelt in ((90.0, True), (60.0, True), (30.0, False)):
            source_map.learn([(0.0, x, 0.0), (x, 0.0, 0.0)], smelt)
    (x, y), variance = source_map.mean()
    assert 35.0 < x < 55.0
    assert abs(y) < 1.5
    best_x, best_y = source_map.best()
    assert 30.0 < best_x < 60.0
    assert abs(best_y) < 2.0
    assert variance < 150.0


def test_the_map_knows_nothing_at_first_and_forgets_what_it_learnt():
    source_map = SourceMap(ARENA, Lpso())
    assert source_map.mean()[0] == pytest.approx((50.0, 0.0))
    assert source_map.best() == pytest.approx((50.0, 0.0))
    source_map.learn(EAST, True)
    learnt = max(source_map.log)
    source_map.forget(0.5)
    assert max(source_map.log) == pytest.approx(0.5 * learnt)


def test_draws_from_the_map_have_its_mean():
    source_map = SourceMap(ARENA, Lpso())
    for _ in range(10):
        source_map.learn(EAST, True)
    drawn = [source_map.drawn((n + 0.5) / 400) for n in range(400)]
    assert np.mean(drawn, axis=0) == pytest.approx(source_map.mean()[0], abs=0.5)


def test_air_from_outside_of_the_arena_and_air_that_stands_still_teach_nothing():
    source_map = SourceMap(ARENA, Lpso())
    source_map.learn([(0.0, -20.0, 0.0), (50.0, -70.0, 0.0)], True)
    source_map.learn([(0.0, 40.0, 0.0), (50.0, 40.0, 0.0)], True)
    assert set(source_map.log) == {0.0}


# The cooperative control system


def test_the_nearest_neighbours_are_taken_and_of_two_as_near_the_lower_number():
    fresh = [(1.0, state_of(j, x)) for j, x in ((4, 1.0), (1, 9.0), (3, -1.0), (2, 2.0))]
    assert [s.robot for _, s in nearest(own_at(), fresh, 2)] == [3, 4]
    assert [s.robot for _, s in nearest(own_at(), fresh[:1], 2)] == [4]


# Whole swarms


@pytest.mark.parametrize(("algorithm", "topology"), list(zip(RIVALS, ["line", "star", "ring"], strict=True)))
def test_a_rival_searches_on_sparse_graphs_with_a_robot_killed_and_keeps_apart(algorithm, topology):
    """Nobody hears of the dead robot any more, so that only the living can keep apart."""
    swarm = MemorySwarm(scenario(algorithm=algorithm, topology=topology, max_time=18.0), wire=True)
    living = [0, 1, 3, 4]
    nearest_pair = math.inf
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
        hands = swarm.session.world.bodies.hands()[living]
        nearest_pair = min(nearest_pair, *(math.dist(a, b) for a, b in combinations(hands, 2)))
        if swarm.session.world.tick == 200:
            swarm.kill(2)
    assert nearest_pair > 0.4
    estimates = [swarm.robots[i].session.agent.estimate for i in living]
    assert all(e is not None and 0.0 <= e[0] <= 100.0 and abs(e[1]) <= 50.0 for e in estimates)


@pytest.mark.parametrize("algorithm", ["lpso", "ccs-like"])
def test_a_rival_that_uses_wind_finds_a_source_that_is_near_most_times(algorithm):
    """Not always: with seed 0 the group of `ccs-like` loses the plume and rests at a decision that is 9 m off."""
    near = {"algorithm": algorithm, "topology": "ring", "source__x": 35.0, "max_time": 120.0}
    outcomes = [run_in_memory(scenario(seed=seed, **near)) for seed in range(3)]
    assert sum(outcome.found for outcome in outcomes) >= 2
    assert min(outcome.min_pair_distance for outcome in outcomes) > 0.4
