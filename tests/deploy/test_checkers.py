"""Checkers: true runs keep every promise; every way of tampering with a history is seen, at its tick."""

import math
from itertools import pairwise

import pytest
from history_helpers import broken, change_act, change_moved, kept, kept_with_death, look, tampered
from msgspec.structs import replace
from swarm_helpers import near_the_plume

from deploy.checkers.check import History, check_run, unplanned
from protocol.history.records import Result, Verdict


@pytest.fixture(scope="module")
def searched() -> History:
    """Five robots of a ring smell the odour and fuse; nobody finds the source in time."""
    return kept(near_the_plume(seed=3))[0]


@pytest.fixture(scope="module")
def found() -> History:
    """The source is found."""
    return kept(near_the_plume(source__x=60.0, source__y=2.0, seed=3, max_time=60.0))[0]


@pytest.fixture(scope="module")
def bereft() -> History:
    """Robot 2 dies at tick 60, driving."""
    return kept_with_death(near_the_plume(seed=3), 2, 60)


@pytest.fixture(scope="module")
def sensing() -> History:
    """Robots that sense each other and hear nobody for a second."""
    parted = [{"kind": "partition", "at": 1.0, "until": 2.0, "groups": [[0, 1], [2, 3, 4]]}]
    return kept(near_the_plume(seed=3, sensors__proximity=3.0, max_time=4.0, plume__warm_up=20.0, faults=parted))[0]


@pytest.mark.parametrize("algorithm", ["cfpso", "dcs-ft", "ftmcs", "ccs-like", "lpso", "surge-cast", "circular"])
def test_a_true_run_of_any_algorithm_keeps_every_promise(algorithm):
    history, _ = kept(near_the_plume(algorithm=algorithm, plume__warm_up=60.0, max_time=3.0))
    assert broken(history) == {}


@pytest.fixture(scope="module")
def declared() -> History:
    """Robots begin at the source, which ends nothing, and the swarm declares it."""
    places = [[24.0, float(y)] for y in (-4, -2, 0, 2, 4)]
    by_word = {"algorithm": "plume-map", "declaration__stop": "declared", "start__positions": places, "max_time": 200.0}
    return kept(near_the_plume(topology="line", **by_word))[0]


def test_a_run_that_the_swarm_ended_by_its_word_keeps_every_promise(declared):
    assert declared.verdicts[0].reason == "declared"
    assert declared.results[0].found
    assert broken(declared) == {}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"found": False, "finder": -1}, 'as "declared", found False by robot -1, but robot'),
        ({"finder": 9}, "found True by robot 9, but robot"),
    ],
)
def test_an_outcome_that_forgets_who_reached_the_source_is_seen(declared, changes, words):
    other = tampered(declared, lambda history: history.results.append(replace(history.results.pop(), **changes)))
    assert words in look("verdict", other).counterexample


@pytest.mark.parametrize("topology", ["all", "ring", "line", "star", "directed-ring"])
@pytest.mark.parametrize("robots", [1, 4])
def test_a_true_run_on_every_graph_keeps_every_promise(topology, robots):
    history, _ = kept(near_the_plume(topology=topology, robots=robots, plume__warm_up=60.0, max_time=3.0), wire=True)
    assert broken(history) == {}


def test_every_checker_has_facts_to_look_at(searched, found, bereft, sensing):
    facts = {}
    for history in (searched, found, bereft, sensing):
        assert broken(history) == {}
        for finding in check_run(history):
            facts[finding.name] = facts.get(finding.name, 0) + finding.facts
    assert all(facts.values()), facts
    assert found.verdicts[0].reason == "found"


def test_the_hull_is_not_promised_of_a_step_that_overshoots():
    history, _ = kept(near_the_plume(fusion__step="explicit", max_time=3.0))
    assert "explicit" in look("hull", history).skipped
    assert "explicit" in look("contraction", history).skipped


def test_a_run_without_filter_says_that_there_is_nothing_to_look_at():
    history, _ = kept(near_the_plume(algorithm="consensus", max_time=2.0))
    assert "no Kalman filter" in look("covariance", history).skipped


def use(robot: int, age: int = 0, weight: float = 1.0):
    def tamper(history: History) -> None:
        change_act(history, 0, 40, used=((robot, age, weight, None),))

    return tamper


@pytest.mark.parametrize(
    ("tamper", "words"),
    [
        (use(2), "robot 0 used robot 2's state of tick 40 at tick 40 (2.00 s), but there is no such edge"),
        (use(1, weight=3.0), "its weight was 3 and the graph says 1"),
        (use(1, age=41), "it had never heard that"),
        (lambda h: change_act(h, 0, 40, heard=((1, 1, 5),)), "robot 0 heard robot 1's state of tick 39 at tick 40"),
        (lambda h: change_act(h, 3, 40, heard=((1, 0, 5),)), "the world did not let it hear that"),
    ],
)
def test_states_of_others_than_neighbours_are_seen(searched, tamper, words):
    assert words in look("neighbours", tampered(searched, tamper)).counterexample


@pytest.mark.parametrize(("age", "words"), [(11, "0.55 s old"), (200, "10.00 s old"), (-1, "ahead")])
def test_stale_states_are_seen(searched, age, words):
    found = look("freshness", tampered(searched, use(1, age)))
    assert words in found.counterexample
    assert found.counterexample.startswith("robot 0 used robot 1's state of tick")


def test_a_state_of_just_the_bound_is_not_stale(searched):
    assert look("freshness", tampered(searched, use(1, 10))).passed


def swap_told(history: History) -> None:
    sent = history.lives[4][0].sent
    sent[30], sent[31] = sent[31], sent[30]


@pytest.mark.parametrize(
    ("tamper", "words"),
    [
        (swap_told, "robot 4 told its state of tick 30 after that of tick 31"),
        (use(1, 3), "robot 1's state of tick 37, after it had used that of tick 39, at tick 40"),
        (lambda h: h.moved.pop(50), "the world went from tick 49 to tick 51"),
        (lambda h: h.lives[1][0].acted.insert(9, h.lives[1][0].acted[5]), "robot 1 acted at tick 5 after tick 8"),
    ],
)
def test_ticks_that_go_back_are_seen(searched, tamper, words):
    assert words in look("order", tampered(searched, tamper)).counterexample


@pytest.mark.parametrize("P", [0.0, -1e-9, math.nan, math.inf])
def test_a_covariance_that_is_not_positive_is_seen(searched, P):
    def tamper(history: History) -> None:
        act = history.lives[1][0].acted[70]
        change_act(history, 1, 70, mind=replace(act.mind, P=P))

    assert f"robot 1's covariance was {P:g} m² at tick 70" in look("covariance", tampered(searched, tamper)).counterexample


def move_fusion(history: History) -> None:
    x, y = history.lives[2][0].acted[90].fusion
    change_act(history, 2, 90, fusion=(x + 30.0, y))


def forget_fusion(history: History) -> None:
    sent = history.lives[2][0].sent
    sent[90] = replace(sent[90], fusion=(1.0, 2.0))


@pytest.mark.parametrize(
    ("tamper", "words"),
    [
        (move_fusion, "robot 2's fusion state went to x = "),
        (forget_fusion, "robot 2's fusion state changed from "),
    ],
)
def test_a_fusion_that_leaves_its_hull_is_seen(searched, tamper, words):
    example = look("hull", tampered(searched, tamper)).counterexample
    assert words in example
    assert "tick 90" in example


def test_a_fusion_that_does_not_contract_is_seen_though_it_stays_in_its_hull(searched):
    """Robots that keep what they have: no state leaves a hull, but nobody comes nearer to the others."""

    def stand(history: History) -> None:
        for lives in history.lives.values():
            kept_state = None
            for n, (sent, act) in enumerate(zip(lives[0].sent, lives[0].acted, strict=True)):
                if act.fusion is None:
                    continue
                kept_state = kept_state or act.fusion
                lives[0].acted[n] = replace(
                    act,
                    fusion=kept_state,
                    used=tuple((j, age, a, None if y is None else start[j]) for j, age, a, y in act.used),
                )
                if sent.begun:
                    lives[0].sent[n] = replace(sent, fusion=kept_state)

    start = {i: next(a.fusion for a in lives[0].acted if a.fusion) for i, lives in searched.lives.items()}
    wrong = tampered(searched, stand)
    assert look("contraction", searched).facts > 100
    assert "the robots' disagreement went from" in look("contraction", wrong).counterexample


def test_disagreement_shrinks_as_fast_as_promised_and_not_ten_times_as_fast():
    """The bound is worth something: what a linear fusion does in a tick is not enough for a tick of ten times the length."""
    history, _ = kept(near_the_plume(fusion__beta=0.0, topology="all", seed=3))
    assert look("contraction", history).passed
    timing = replace(history.scenario.timing, tick=0.5)
    slower = tampered(history, lambda h: setattr(h, "scenario", replace(h.scenario, timing=timing)))
    assert "it must be at most" in look("contraction", slower).counterexample


def held_robot(history: History, tick: int) -> tuple:
    return next(m for m in history.moved if m.tick == tick).poses


def speed_up(tick: int):
    def tamper(history: History) -> None:
        poses = list(held_robot(history, tick))
        x, y, theta, _, omega = poses[2]
        poses[2] = (x, y, theta, 0.8, omega)
        change_moved(history, tick, poses=tuple(poses))

    return tamper


def never_stop(history: History) -> None:
    for before, after in pairwise(list(history.moved)):
        if 2 in after.dead:
            poses = list(after.poses)
            poses[2] = (*poses[2][:3], *held_robot(history, before.tick)[2][3:])
            change_moved(history, after.tick, poses=tuple(poses))


@pytest.mark.parametrize(
    ("tamper", "words"),
    [
        (speed_up(65), "robot 2 was to stand still, but a wheel went from"),
        (speed_up(150), "to 0.8000 m/s at tick 150"),
        (never_stop, "robot 2 was held for"),
        (lambda h: change_moved(h, 70, drives=((2, 0.1, 0.1),)), "robot 2 was lost, but a drive of it was taken at tick 70"),
    ],
)
def test_driving_after_the_safe_stop_is_seen(bereft, tamper, words):
    assert words in look("stopped", tampered(bereft, tamper)).counterexample


def one_more(history: History) -> None:
    history.verdicts.append(Verdict(history.moved[-1].tick, "time out"))


def say(reason: str, **outcome: object):
    def tamper(history: History) -> None:
        history.verdicts[0] = replace(history.verdicts[0], reason=reason)
        history.results[0] = replace(history.results[0], ended=reason, **outcome)

    return tamper


@pytest.mark.parametrize(
    ("tamper", "words"),
    [
        (one_more, "there were 2 verdicts in the run"),
        (lambda h: h.verdicts.clear(), "there were 0 verdicts in the run: none"),
        (lambda h: h.results.clear(), "there were 0 outcomes"),
        (say("time out", found=False), "as \"time out\", but robot"),
        (lambda h: h.results.__setitem__(0, Result(False, -1, 1.0, "found", "")), "but the outcome says"),
        (lambda h: h.results.__setitem__(0, replace(h.results[0], finder=99)), "by robot 99, but it was robot"),
        (lambda h: h.results.__setitem__(0, replace(h.results[0], time=999.0)), "after the end of the run"),
        (lambda h: h.moved.append(replace(h.moved[-1], tick=h.moved[-1].tick + 1)), "but the world went on to tick"),
    ],
)
def test_a_verdict_that_is_not_one_or_not_true_is_seen(found, tamper, words):
    assert words in look("verdict", tampered(found, tamper)).counterexample


@pytest.mark.parametrize(
    ("tamper", "words"),
    [
        (say("found", found=True, finder=1), "nobody had got there"),
        (lambda h: setattr(h, "scenario", replace(h.scenario, max_time=50.0)), "before max_time of 50 s"),
    ],
)
def test_a_search_that_was_in_vain_cannot_be_told_otherwise(searched, tamper, words):
    assert words in look("verdict", tampered(searched, tamper)).counterexample


def drive_harder(history: History) -> None:
    moved = history.moved[31]
    (i, left, right), *others = moved.drives
    change_moved(history, 31, drives=((i, left + 0.1, right), *others))


@pytest.mark.parametrize(
    ("tamper", "words"),
    [
        (lambda h: change_act(h, 0, 40, heard=((1, 0, 12345),)), "of tick 40 at tick 40 (2.00 s), but robot 1 had sent"),
        (lambda h: h.lives[4][0].sent.pop(33), "heard a state of robot 4 of tick 33"),
        (lambda h: h.lives.pop(4), "but robot 4 never sent one"),
        (drive_harder, "had not asked for that"),
    ],
)
def test_what_was_heard_or_driven_without_being_sent_is_seen(searched, tamper, words):
    assert words in look("conservation", tampered(searched, tamper)).counterexample


def test_a_planned_liar_is_seen_and_breaks_no_other_promise():
    liar = {"kind": "liar", "robot": 3, "lies": "fusion", "offset": [20.0, 0.0], "at": 1.0, "until": 2.0}
    history, _ = kept(near_the_plume(faults=[liar], max_time=3.0))
    assert broken(history) == {
        "honesty": "robot 3 told robot 2 in its state of tick 20 something else than it held, heard at tick 20 (1.00 s)"
    }
    assert unplanned(history) == []
    change_act(history, 0, 50, heard=((1, 0, 12345),))
    assert "conservation" in [finding.name for finding in unplanned(history)]


@pytest.mark.parametrize("seed", [3, 11])
def test_faults_of_the_radio_and_of_processes_break_no_promise(seed):
    faults = [
        {"kind": "crash", "robot": 1, "at": 1.0, "restart": 1.0},
        {"kind": "hang", "robot": 2, "at": 1.5, "until": 3.0},
        {"kind": "loss", "probability": 0.2},
        {"kind": "delay", "delay": 0.1, "jitter": 0.6},
        {"kind": "duplicate", "probability": 0.2},
        {"kind": "reorder", "probability": 0.2},
    ]
    history, _ = kept(near_the_plume(faults=faults, seed=seed, max_time=5.0))
    assert broken(history) == {}
    assert len(history.lives[1]) == 2
    assert look("stopped", history).facts > 40


def test_robots_that_came_too_near_are_seen(sensing):
    def tamper(history: History) -> None:
        x, y, theta, nu, omega = history.moved[30].poses[1]
        poses = list(history.moved[30].poses)
        poses[4] = (x + 0.5, y, theta, nu, omega)
        change_moved(history, 30, poses=tuple(poses))

    assert "robots 1 and 4 were 0.500 m apart at tick 30" in look("clearance", tampered(sensing, tamper)).counterexample


WEAK = {"kind": "actuator", "robot": 1, "wheel": "left", "strength": 0.5}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, "do not sense each other"),
        ({"sensors__proximity": 1.0}, "1.63 m are needed"),
        ({"sensors__proximity": 3.0, "start__spacing": 0.5}, "start nearer"),
        ({"sensors__proximity": 3.0, "faults": [WEAK]}, "weak"),
    ],
)
def test_a_distance_that_nobody_promised_is_not_asked_for(changes, words):
    history, _ = kept(near_the_plume(plume__warm_up=5.0, max_time=0.2, **changes))
    assert words in look("clearance", history).skipped
