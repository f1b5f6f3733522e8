"""plume-map: what speaks for a place beyond a narrow posterior."""

import pytest
from judging_helpers import reading, view
from plume_helpers import ARENA, TABLE, record

from robot_agent.decision.plume_map import PlumeMapDecision
from robot_agent.hand import Own
from robot_agent.plume.events import unpack
from robot_agent.plume.evidence import Evidence


def evidence_of(*hits):
    evidence = Evidence(TABLE)
    for k, x, y in hits:
        evidence.add(k, unpack(record(hit=True, x=x, y=y, D=0.05), ARENA))
    return evidence


def test_a_meeting_is_a_hit_after_a_pause():
    evidence = evidence_of((10, 42.0, 3.0), (11, 42.0, 3.0), (14, 42.0, 3.0), (20, 42.0, 3.0), (21, 42.0, 3.0))
    assert evidence.meetings(0, 40.0, 3.0) == 2, "after 10 and 14 a hit came within three seconds"
    assert evidence.meetings(10, 40.0, 3.0) == 1, "since then"
    assert evidence.meetings(20, 40.0, 3.0) == 0


def test_a_meeting_counts_for_a_place_that_explains_it():
    evidence = evidence_of((10, 42.0, 3.0), (20, 42.0, 4.4), (30, 42.0, 3.0))
    assert evidence.meetings(0, 40.0, 3.0) == 2, "the one 1.4 m beside it neither speaks for it nor against it"
    assert evidence.meetings(0, 39.0, 3.0) == 2


def test_a_meeting_far_downwind_does_not_count():
    evidence = evidence_of((10, 42.0, 3.0), (20, 48.0, 3.0), (30, 42.0, 3.0))
    assert evidence.meetings(0, 40.0, 3.0) == 2


@pytest.mark.parametrize("where", [(42.0, 6.0), (36.0, 3.0)], ids=["beside", "upwind"])
def test_a_hit_that_a_source_there_does_not_give_speaks_against_the_place(where):
    evidence = evidence_of((10, 42.0, 3.0), (20, *where), (30, 42.0, 3.0))
    assert evidence.meetings(0, 40.0, 3.0) == 1, "only the one after it"


def test_only_so_many_hits_are_kept():
    evidence = evidence_of(*((10 * k, 42.0, 3.0) for k in range(1000)))
    assert 128 <= evidence.meetings(-1, 40.0, 3.0) <= 256


def test_a_decision_tells_the_meetings_of_which_it_knows():
    scenario = view(algorithm="plume-map", topology="line")
    decision = PlumeMapDecision(scenario)
    for k, ppt in enumerate((0.0, 9000.0, 9000.0, 0.0, 0.0, 0.0, 9000.0, 0.0, 0.0, 0.0)):
        decision.record(Own(reading(20 * k, ppt=ppt), scenario.body))
    assert [decision.meetings(since, (50.0, 0.0)) for since in (0.0, 1.0, 6.0)] == [2, 1, 0]
