"""When a process is started again, told with a clock that is stepped by hand."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deploy.launch.policy import GiveUp, Mode, Policy, Restart
from protocol.errors import ScenarioError
from protocol.scenario.load import load_scenario
from protocol.scenario.supervision import Supervision

KILLED = -9


def policy(mode: Mode = Mode.ALWAYS, **values: object) -> Policy:
    return Policy(mode, Supervision(**values))


def test_first_restart_is_at_once_and_the_pauses_double_up_to_the_longest():
    p = policy(backoff=0.5, max_backoff=3.0, max_restarts=6, window=1000.0)
    starts = []
    now = 10.0
    for _ in range(6):
        decision = p.ended(now, KILLED)
        assert isinstance(decision, Restart)
        starts.append(decision.at - now)
        now = decision.at + 1.0
    assert starts == [0.0, 0.5, 1.0, 2.0, 3.0, 3.0]
    assert p.restarts == 6


def test_process_that_ends_too_often_is_given_up_with_a_sentence_and_for_good():
    p = policy(max_restarts=2, window=60.0)
    assert isinstance(p.ended(0.0, KILLED), Restart)
    assert isinstance(p.ended(1.0, KILLED), Restart)
    decision = p.ended(2.0, KILLED)
    assert isinstance(decision, GiveUp)
    assert decision.why == (
        "is given up: it ended with signal 9 and has been started again 2 times within 60 s, which is all that"
        " supervision.max_restarts allows"
    )
    assert p.given_up
    assert p.ended(1000.0, KILLED) is None


def test_what_lies_before_the_window_is_forgotten_and_the_pauses_begin_anew():
    p = policy(max_restarts=1, window=60.0)
    assert p.ended(0.0, KILLED) == Restart(0.0, 1)
    assert p.ended(61.0, KILLED) == Restart(61.0, 2)
    assert isinstance(p.ended(62.0, KILLED), GiveUp)


@pytest.mark.parametrize(
    ("mode", "status", "again"),
    [
        (Mode.NEVER, KILLED, False), (Mode.NEVER, 0, False), (Mode.CRASHED, 0, False), (Mode.CRASHED, 3, True),
        (Mode.CRASHED, KILLED, True), (Mode.ALWAYS, 0, True), (Mode.ALWAYS, KILLED, True),
    ],
)  # fmt: skip
def test_mode_says_which_ends_call_for_a_restart(mode, status, again):
    assert (policy(mode).ended(5.0, status) is not None) is again


def test_no_restart_allowed_gives_up_at_the_first_end():
    decision = policy(max_restarts=0).ended(0.0, 3)
    assert isinstance(decision, GiveUp)
    assert "ended with status 3" in decision.why


@given(gaps=st.lists(st.floats(0.0, 100.0), max_size=40), most=st.integers(0, 6), window=st.floats(1.0, 200.0))
def test_never_more_restarts_within_any_window_than_allowed(gaps, most, window):
    p = policy(max_restarts=most, window=window)
    now, starts = 0.0, []
    for gap in gaps:
        now += gap
        decision = p.ended(now, KILLED)
        if not isinstance(decision, Restart):
            break
        assert decision.at >= now
        starts.append(decision.at)
        now = decision.at
    for at in starts:
        assert sum(at - window < other <= at for other in starts) <= most


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"supervision.restart": "often"}, 'supervision.restart is "often"; it must be "always", "crashed" or "never"'),
        ({"supervision.backoff": 20.0}, "supervision.backoff is 20; it must be at most supervision.max_backoff"),
        ({"supervision.max_restarts": -1}, "supervision.max_restarts is -1; it must be a whole number from 0 to 1000"),
        ({"supervision.checkpoint_every": 5.0, "clock": "realtime"}, "it must be 0 with clock = \"realtime\""),
    ],
)  # fmt: skip
def test_bad_supervision_is_refused_with_a_sentence(settings, sentence):
    with pytest.raises(ScenarioError) as refused:
        load_scenario(None, overrides=[(name, value, "test") for name, value in settings.items()])
    assert sentence in str(refused.value)
