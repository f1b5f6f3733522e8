"""The world hears the swarm's word in lock-step, and after it was killed; the word of who left is forgotten."""

import pytest
from test_recoverable import Told
from test_snapshot import scenario_of

from protocol.messages import Drive, Event, Linked
from protocol.scenario import linked_to, scenario_digest
from world_server.checkpoints import Checkpoints
from world_server.recoverable import RecoverableSession
from world_server.session import DECLARED

HERE, THERE = (2.0, 0, 1.0, 1.0), (1.0, 1, 30.0, 4.0)
STOP = {"declaration.stop": "declared"}


def drive(session: RecoverableSession, say: dict[int, tuple]) -> None:
    """All who take part answer once, and tell `say`."""
    world = session.world
    for i in sorted(session.awaited):
        for j in range(world.scenario.robots):
            session.take_linked(Linked(j, world.tick if j == i else -1, linked_to(world.scenario.graph, j)))
        session.admit(i)
    complete = session.idle
    for i in sorted(world.live):
        complete = session.take_drive(Drive(i, world.tick, 0.1, 0.1, say.get(i)))
    if complete:
        session.step()


@pytest.mark.parametrize("saved_at", [0, 4, 7])
def test_a_killed_world_comes_back_with_what_the_robots_had_declared(tmp_path, saved_at):
    scenario = scenario_of(3, **STOP)
    kept = Checkpoints(tmp_path, "run", scenario_digest(scenario))
    first = Told(scenario, kept).session
    first.start()
    for tick in range(10):
        if tick == saved_at:
            kept.write(tick, first.world.snapshot(), first.snapshot(), 1.0)
        drive(first, {} if tick < 3 else {0: HERE} if tick < 6 else {0: HERE, 1: THERE})
    again = Checkpoints(tmp_path, "run", scenario_digest(scenario))
    told = Told(scenario, again, again.load())
    second = told.session
    assert told.said == []
    assert second.declarations.of == first.declarations.of == {0: HERE, 1: THERE}
    second.go_on()
    for session in (first, second):
        drive(session, dict.fromkeys(range(3), THERE))
    assert (first.ended, second.ended) == (DECLARED, DECLARED)
    assert second.declarations.common == first.declarations.common == THERE
    assert (second.declarations.at, second.world.digest) == (first.declarations.at, first.world.digest)
    # Killed once more between the end and the last word: it does not begin to run again.
    third = Told(scenario, again, Checkpoints(tmp_path, "run", scenario_digest(scenario)).load())
    assert third.session.ended == DECLARED


def test_what_has_been_said_once_is_not_written_down_again(tmp_path):
    inputs = []
    scenario = scenario_of(2, **STOP)
    told = Told(scenario, None)
    told.session._journal = inputs.append
    told.session.start()
    for _ in range(3):
        drive(told.session, {0: HERE})
    assert [each.declared for each in inputs] == [((0, HERE),), (), ()]


@pytest.mark.parametrize("fault", [{"kind": "crash", "restart": 0.2}, {"kind": "hang", "until": 0.4}], ids=["crash", "hang"])
def test_a_robot_that_is_away_holds_nobody_up_and_must_say_it_again_when_it_is_back(fault):
    scenario = scenario_of(3, faults=({"robot": 1, "at": 0.2, **fault},), **STOP)
    session = Told(scenario, None).session
    session.start()
    while 1 in session.world.live:
        drive(session, {1: THERE})
    assert session.declarations.of == {}
    while 1 not in session.world.live:
        drive(session, {0: THERE})
    drive(session, {0: THERE, 2: THERE})
    assert session.ended is None
    drive(session, dict.fromkeys(range(3), THERE))
    assert session.ended == DECLARED


def test_those_who_are_there_end_the_run_while_another_is_away():
    scenario = scenario_of(3, faults=({"kind": "crash", "robot": 1, "at": 0.2, "restart": 5.0},), **STOP)
    told = Told(scenario, None)
    session = told.session
    session.start()
    while 1 in session.world.live:
        drive(session, {})
    drive(session, {0: HERE, 2: HERE})
    assert session.ended == DECLARED
    assert [event.text for event in told.said if isinstance(event, Event)][-1] == "all robots declare the same place"


def test_a_robot_that_disagreed_and_is_lost_leaves_the_others_in_agreement():
    session = Told(scenario_of(3, **STOP), None).session
    session.start()
    drive(session, {0: HERE, 1: THERE, 2: HERE})
    assert session.ended is None
    session.lose(1)
    drive(session, {0: HERE, 2: HERE})
    assert session.ended == DECLARED
