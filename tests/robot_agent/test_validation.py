"""Which states of neighbours are believed."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from judging_helpers import DT, own, told, view

from robot_agent.algorithms import algorithm
from robot_agent.validation import Validation


def judge(**values) -> tuple[Validation, object]:
    scenario = view(topology="all", **values)
    return Validation(scenario, algorithm(scenario.algorithm).controller(scenario)), scenario


def believed(validation, scenario, state, tick=None) -> bool:
    return bool(validation.sift(own(state.tick if tick is None else tick, scenario), [state]))


def test_an_honest_robot_is_believed_at_every_tick():
    validation, scenario = judge()
    for k in range(200):
        assert believed(validation, scenario, told(1, k, x=60.0 - 0.8 * DT * k))
    assert validation.total == 0


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"x": 500.0}, "place"),
        ({"vx": 3.0}, "speed"),
        ({"tick": 10_000}, "tick"),
        ({"tick": -1}, "tick"),
        ({"detected_at": 19.0}, "time"),
        ({"first_detected_at": 19.0, "detected_at": 19.5}, "time"),
        ({"first_detected_at": 4.0, "detected_at": 3.0}, "time"),
        ({"first_detected_at": -1.0}, "time"),
        ({"best_at": 19.0}, "time"),
        ({"best_concentration": 2e6}, "concentration"),
        ({"best_concentration": -1.0}, "concentration"),
        ({"best_x": -400.0}, "concentration"),
        ({"fusion_y": 300.0}, "decision"),
        ({"h_x": -300.0}, "decision"),
        ({"search_leg": 10**6}, "search"),
        ({"search_leg": -2}, "search"),
        ({"search_by": 5}, "search"),
        ({"search_x": 0.0, "search_y": 0.0}, "search"),
        ({"search_x": 3.0}, "search"),
    ],
)
def test_what_cannot_be_is_not_believed_and_counted_with_its_reason(changed, reason):
    validation, scenario = judge()
    assert believed(validation, scenario, told(1, 100))
    assert not believed(validation, scenario, told(1, 101, **changed), tick=101)
    assert validation.rejected == {(1, reason): 1}
    assert believed(validation, scenario, told(2, 101))  # nobody else suffers for it


def test_a_robot_that_jumps_is_silent_and_heard_again_after_so_many_states_from_its_new_place():
    validation, scenario = judge(trust__readmit=5)
    assert believed(validation, scenario, told(1, 0, x=60.0))
    answers = [believed(validation, scenario, told(1, k, x=80.0)) for k in range(1, 10)]
    assert answers == [False] * 5 + [True] * 4
    assert validation.rejected == {(1, "jump"): 1, (1, "probation"): 4}


def test_a_robot_that_jumps_to_and_fro_is_never_heard_again():
    validation, scenario = judge()
    assert believed(validation, scenario, told(1, 0, x=60.0))
    assert not any(believed(validation, scenario, told(1, k, x=60.0 + 20.0 * (k % 2))) for k in range(1, 100))


def test_the_same_state_again_does_not_end_the_probation():
    validation, scenario = judge()
    assert believed(validation, scenario, told(1, 0, x=60.0))
    assert not any(believed(validation, scenario, told(1, 1, x=80.0), tick=k) for k in range(1, 100))


def test_one_bad_state_costs_the_sender_no_more_than_the_probation():
    validation, scenario = judge(trust__readmit=5)
    assert believed(validation, scenario, told(1, 0))
    assert not believed(validation, scenario, told(1, 1, vx=50.0))
    assert [believed(validation, scenario, told(1, k)) for k in range(2, 8)] == [False] * 4 + [True] * 2


def test_a_robot_that_was_silent_for_long_may_be_as_far_as_it_can_drive():
    validation, scenario = judge()
    assert believed(validation, scenario, told(1, 0, x=60.0))
    assert believed(validation, scenario, told(1, 600, x=82.0))  # 22 m in 30 s
    assert not believed(validation, scenario, told(1, 601, x=60.0))


@given(ticks=st.lists(st.integers(0, 400), min_size=1, max_size=30))
def test_honest_states_are_believed_whatever_order_they_arrive_in(ticks):
    validation, scenario = judge()
    assert all(believed(validation, scenario, told(1, k, x=60.0 - 0.8 * DT * k), tick=400) for k in ticks)


@given(
    values=st.fixed_dictionaries(
        {},
        optional={
            name: st.floats(-1e12, 1e12)
            for name in ("x", "y", "vx", "vy", "fusion_x", "h_y", "first_detected_at", "detected_at", "best_at",
                         "best_concentration", "best_x", "search_x")
        }
        | {name: st.integers(-(2**63), 2**63 - 1) for name in ("tick", "search_leg", "search_by")},
    )
)
def test_whatever_is_claimed_nothing_beyond_the_bounds_is_used(values):
    validation, scenario = judge()
    for state in validation.sift(own(100, scenario), [told(1, 100, **values)]):
        assert -100.0 <= state.x <= 200.0
        assert state.vx**2 + state.vy**2 < 1.3**2
        assert -60.0 <= state.fusion_x <= 160.0
        assert max(state.detected_at, state.first_detected_at, state.best_at) <= 10.0
        assert 0.0 <= state.best_concentration <= 1e6
        assert -1 <= state.search_leg <= 2 * (state.tick + 1)
        assert state.tick <= 200


def test_a_passed_on_place_that_contradicts_what_the_robot_says_itself_is_left_out():
    validation, scenario = judge()
    assert believed(validation, scenario, told(2, 10, x=30.0))
    false, true = (2, 9, 70.0, 5.0, 0.0, 0.0), (3, 9, 55.0, 5.0, 0.0, 0.0)
    (state,) = validation.sift(own(11, scenario), [told(1, 11, relayed=(false, true))])
    assert state.relayed == (true,)
    assert validation.rejected == {(1, "relayed"): 1}


def test_a_passed_on_place_that_no_body_has_is_left_out():
    validation, scenario = judge()
    here = (50.0, 0.0, 0.0, 0.0)
    for record in ((3, 11, 900.0, *here[1:]), (3, 11, 50.0, 0.0, 9.0, 0.0), (3, 9000, *here), (77, 1, *here)):
        (state,) = validation.sift(own(11, scenario), [told(1, 11, relayed=(record,))])
        assert state.relayed == ()


def test_of_two_places_passed_on_for_one_robot_the_first_counts_until_it_is_old():
    validation, scenario = judge()
    first, second = (3, 10, 20.0, 0.0, 0.0, 0.0), (3, 11, 60.0, 0.0, 0.0, 0.0)
    assert validation.sift(own(11, scenario), [told(1, 11, relayed=(first,))])[0].relayed == (first,)
    assert validation.sift(own(12, scenario), [told(2, 12, relayed=(second,))])[0].relayed == ()
    later = (3, 90, 60.0, 0.0, 0.0, 0.0)
    assert validation.sift(own(90, scenario), [told(2, 90, relayed=(later,))])[0].relayed == (later,)


def test_a_virtual_robot_off_its_leash_is_not_believed():
    validation, scenario = judge(algorithm="ftmcs")
    honest = (60.5, 5.0, 0.3, 0.0, 2.0, 60.0, 5.0)
    assert believed(validation, scenario, told(1, 100, virtual=honest))
    assert not believed(validation, scenario, told(2, 100, virtual=(90.0, *honest[1:])))
    assert not believed(validation, scenario, told(3, 100, virtual=(*honest[:2], 1e6, *honest[3:])))
    assert not believed(validation, scenario, told(4, 100, virtual=(*honest[:4], 1e6, *honest[5:])))
    assert set(validation.rejected) == {(2, "virtual"), (3, "virtual"), (4, "virtual")}


def test_switched_off_everything_is_believed():
    validation, scenario = judge(trust__check=False)
    assert believed(validation, scenario, told(1, 0, x=1e9, vx=1e9, best_concentration=1e9))
    assert validation.total == 0
