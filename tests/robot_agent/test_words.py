"""Words of the neighbours: whose measurement the resilient fusion goes by, with liars and without."""

from hypothesis import assume, given, settings
from hypothesis import strategies as st
from judging_helpers import DT, own, reading, told, view

from deploy.memory_run import run_in_memory
from protocol.scenario.load import load_scenario
from robot_agent.agent import Agent
from robot_agent.words import Words, judge

numbers = st.floats(-50, 50)
points = st.tuples(numbers, numbers)
words = st.tuples(numbers, numbers, st.floats(0, 20))
RESILIENT = {"fusion__kind": "resilient", "topology": "all"}


def inside(u, honest):
    return all(min(axis) <= c <= max(axis) for c, axis in zip(u, zip(*honest, strict=True), strict=True))


@st.composite
def neighbourhoods(draw):
    """Own word or none, honest words, lies, own state, and how many lies are to be expected."""
    liars = draw(st.integers(1, 2))
    lies = draw(st.lists(st.tuples(numbers, numbers, st.floats(0, 30)), max_size=liars))
    return draw(st.none() | words), draw(st.lists(words, max_size=6)), lies, draw(points), liars


@given(neighbourhoods(), st.booleans())
def test_no_lie_pulls_the_input_out_of_the_hull_of_honest_words_and_the_own_state(around, follow):
    mine, honest, lies, y, liars = around
    u = judge(mine, [*lies, *honest], y, liars, follow=follow)
    assume(u is not None and (mine is not None or len(honest) + len(lies) > liars))
    assert inside(u, [y, *(w[:2] for w in honest), *([mine[:2]] if mine else [])])


@given(neighbourhoods())
def test_where_2f_plus_1_have_words_the_input_is_in_the_hull_of_the_honest_words_alone(around):
    mine, honest, lies, y, liars = around
    assume((mine is not None) + len(honest) + len(lies) > 2 * liars)
    u = judge(mine, [*lies, *honest], y, liars, follow=True)
    assert inside(u, [w[:2] for w in ([mine, *honest] if mine else honest)])


@given(neighbourhoods())
@settings(max_examples=50)
def test_a_robot_that_waits_takes_no_word_that_could_be_a_lie_alone(around):
    _, _, lies, y, liars = around
    assert judge(None, lies, y, liars, follow=False) is None


def test_a_lone_word_is_followed_and_two_that_contradict_each_other_are_not():
    find, other, y = (30.0, 2.0, 5.0), (60.0, 9.0, 6.0), (45.0, 0.0)
    assert judge(None, [find], y, 1, follow=True) == (30.0, 2.0)
    assert judge(None, [find], y, 1, follow=False) is None
    assert judge(None, [], y, 1, follow=True) is None
    assert judge(None, [find, other], y, 1, follow=True) == (45.0, 2.0)
    assert judge(find, [other], y, 1, follow=True) == (30.0, 2.0), "its own word outweighs one neighbour's"


def test_the_latest_words_vote_and_their_order_does_not_matter():
    late = [(30.0, 0.0, 9.0), (31.0, 5.0, 8.0), (33.0, 1.0, 7.0)]
    early = [(90.0, 40.0, 1.0), (91.0, 41.0, 2.0), (92.0, 42.0, 3.0)]
    assert judge(None, late + early, (0.0, 0.0), 1, follow=True) == (31.0, 1.0)
    assert judge(None, early + late[::-1], (0.0, 0.0), 1, follow=True) == (31.0, 1.0)


def test_words_that_no_honest_robot_could_have_are_no_votes():
    judge_of_0 = Words(view(**RESILIENT))
    t, y, good = 60.0, (50.0, 0.0), (20.0, 3.0, 59.0)

    def heard(*said):
        return judge_of_0.input(t, None, [(1.0, told(i, 1200, word=w)) for i, w in enumerate(said, 1)], y)

    assert heard(good) == (20.0, 3.0)
    for impossible in ((-20.0, 3.0, 60.0), (20.0, 70.0, 60.0), (20.0, 9.0, 70.0), (20.0, 9.0, 30.0)):
        assert heard(impossible) is None
        assert heard(good, impossible) == (20.0, 3.0)
    assert judge_of_0.input(t, (90.0, 9.0, 39.0), [(1.0, told(1, 1200, word=good))], y) == (20.0, 3.0), "too long ago"


def test_a_robot_tells_a_word_when_it_has_measured_and_its_fusion_is_resilient():
    for kind, judged in (("resilient", "words"), ("resilient", "states"), ("plain", "words")):
        agent = Agent(view(fusion__kind=kind, fusion__judge=judged, topology="all"))
        tells = []
        for k in range(25):
            past = {"wind_past": ((1.0, 0.0),) * 100} if k == 0 else {}
            tells.append(agent.sense(reading(k, x=50.0, ppt=5000.0 if k == 20 else 0.0, **past)).word)
            agent.act(())
        assert tells[:21] == [None] * 21
        if (kind, judged) == ("resilient", "words"):
            x, _, at = tells[21]
            assert 0.0 < x < own(0, agent.scenario).x
            assert at == 20 * DT
        else:
            assert tells[21:] == [None] * 4


def test_the_resilient_fusion_finds_the_source_about_as_soon_as_the_plain_one():
    def time(*faults, **values):
        chosen = {"topology": "all", "seed": 7000, "max_time": 250, **values}
        given = [(name.replace("__", "."), value, "test") for name, value in chosen.items()]
        return run_in_memory(load_scenario(None, overrides=[*given, ("faults", list(faults), "test")])).time

    lie = {"kind": "liar", "robot": 2, "lies": "fusion", "offset": [10.0, 10.0]}
    soon = 1.15 * 147.0  # s, what the plain fusion takes with this seed
    assert time(fusion__kind="resilient") < soon
    assert time(lie, fusion__kind="resilient") < soon
