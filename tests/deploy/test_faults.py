"""Stories of planned faults, in memory: who leaves the barrier and comes back, what is told, what repeats."""

from __future__ import annotations

import pytest
from swarm_helpers import near_the_plume

from deploy.faults.random_schedule import random_scenario
from deploy.memory_run import MemorySwarm, run_in_memory
from protocol.bus import Delivery
from protocol.messages import Shared
from protocol.scenario.faults import ClockSkew, Crash, Fault, Hang, Liar, Loss, Sensor, WorldSlow


def swarm_with(*faults: Fault, **values: object) -> MemorySwarm:
    swarm = MemorySwarm(near_the_plume(topology="ring", seed=5, faults=faults, **values))
    swarm.start()
    return swarm


def run_to(swarm: MemorySwarm, tick: int) -> None:
    while swarm.session.world.tick < tick and not swarm.session.over:
        swarm.tick()


def test_a_hung_robot_brakes_is_not_heard_and_goes_on_with_what_it_knew() -> None:
    swarm = swarm_with(Hang(robot=2, at=2.0, until=4.0), max_time=6.0)
    run_to(swarm, 40)
    world, robot = swarm.session.world, swarm.robots[2]
    assert world.live == {0, 1, 3, 4}
    assert all(2 not in [j for j, _ in world.radio.hears(i, 40, world.live)] for i in (1, 3))
    knew = robot.session.agent.estimate
    run_to(swarm, 60)
    place = (world.bodies.x[2], world.bodies.y[2])
    assert (world.bodies.nu[2], world.bodies.omega[2]) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert robot.session.tick == 39
    run_to(swarm, 80)
    assert (world.bodies.x[2], world.bodies.y[2]) == pytest.approx(place, abs=1e-12)
    assert robot.session.agent.estimate == knew
    run_to(swarm, 110)
    assert robot.session.tick >= 109
    assert world.live == {0, 1, 2, 3, 4}
    assert (world.bodies.x[2], world.bodies.y[2]) != pytest.approx(place, abs=1e-3)
    assert swarm.session.faults == ["injected at 2.00 s: robot 2 hangs until 4 s", "robot 2 is back at 4.00 s"]


def test_a_crashed_robot_is_out_for_good_and_the_run_is_no_failure() -> None:
    outcome = run_in_memory(near_the_plume(topology="ring", faults=(Crash(robot=3, at=1.0),), max_time=3.0))
    assert outcome.ended == "time out"
    assert not outcome.failed
    assert outcome.faults == ("injected at 1.00 s: robot 3 crashes",)
    assert outcome.estimate_error[3] is None


def test_when_all_hang_the_world_goes_on_until_they_are_back() -> None:
    faults = (Hang(robot=0, at=1.0, until=2.0), Hang(robot=1, at=1.5, until=3.0))
    outcome = run_in_memory(near_the_plume(robots=2, topology="line", faults=faults, max_time=4.0))
    assert outcome.ended == "time out"
    assert outcome.ticks == 80
    assert outcome.faults[-1] == "robot 1 is back at 3.00 s"


def test_when_all_are_stopped_for_good_the_run_ends_as_planned() -> None:
    faults = (Hang(robot=0, at=1.0), Crash(robot=1, at=1.5))
    outcome = run_in_memory(near_the_plume(robots=2, topology="line", faults=faults, max_time=4.0))
    assert outcome.ended == "all robots have stopped, as planned"
    assert not outcome.failed
    assert outcome.ticks == 30


def test_a_hang_that_goes_over_into_a_crash_is_no_return() -> None:
    faults = (Hang(robot=1, at=1.0, until=2.0), Crash(robot=1, at=2.0))
    outcome = run_in_memory(near_the_plume(topology="ring", faults=faults, max_time=3.0))
    assert outcome.faults == ("injected at 1.00 s: robot 1 hangs until 2 s", "injected at 2.00 s: robot 1 crashes")


def test_a_robot_that_does_not_answer_its_call_is_given_up() -> None:
    swarm = swarm_with(Hang(robot=2, at=1.0, until=2.0), max_time=4.0)
    swarm.robots[2].linked = lambda answer: None
    run_to(swarm, 40)
    assert swarm.session.awaited == {2}
    swarm.tick()
    assert swarm.session.world.tick == 40
    swarm.session.give_up(2)
    run_to(swarm, 1000)
    assert swarm.session.ended == "time out"
    assert swarm.session.faults[-1] == "robot 2 did not come back at 2.00 s"


def test_a_robot_that_is_lost_unplanned_does_not_end_a_wait_for_another() -> None:
    swarm = swarm_with(Hang(robot=2, at=1.0, until=2.0), max_time=3.0)
    answer, held = swarm.robots[2].linked, []
    swarm.robots[2].linked = held.append
    run_to(swarm, 40)
    swarm.kill(0)
    swarm.tick()
    assert swarm.session.world.tick == 40
    answer(held[0])
    run_to(swarm, 1000)
    assert swarm.session.ended == "time out"
    assert swarm.session.world.live == {1, 2, 3, 4}


def told_by(swarm: MemorySwarm, liar: int, listener: int) -> Shared:
    """The newest state of `liar` that waits at `listener`."""
    states = [e.message for e in swarm.robots[listener].bus.inbox if isinstance(e, Delivery)]
    return [m for m in states if isinstance(m, Shared) and m.robot == liar][-1]


def test_a_liars_neighbours_hear_the_lie_in_its_own_name_and_it_believes_the_truth() -> None:
    swarm = swarm_with(Liar(robot=1, lies="position", offset=(20.0, -3.0), at=0.5), max_time=2.0)
    run_to(swarm, 15)
    for i in (1, 3, 4, 2, 0):
        if i != 0:
            swarm.robots[i].pump()
    state = told_by(swarm, 1, 0)
    hand = swarm.session.world.bodies.hands()[1]
    assert state.robot == 1
    assert (state.x - hand[0], state.y - hand[1]) == pytest.approx((20.0, -3.0), abs=1e-9)
    assert swarm.robots[1].session.agent.sense is not None


def test_a_liar_about_detection_wakes_a_swarm_that_smells_nothing() -> None:
    far = {"start__x": 95.0, "start__y": -48.0, "max_time": 3.0}
    lie = Liar(robot=1, lies="detection", ppt=5000.0)
    honest, lied = (
        run_in_memory(near_the_plume(topology="ring", faults=faults, **far)) for faults in ((), (lie,))
    )
    assert honest.first_detection is None
    assert lied.first_detection is None  # the truth
    assert honest.estimate_error == (None,) * 5
    assert None not in (lied.estimate_error[0], lied.estimate_error[2])


def test_a_skewed_clock_is_what_the_robot_believes_and_tells() -> None:
    swarm = swarm_with(*(ClockSkew(robot=i, offset=100.0, drift=0.5) for i in range(5)), max_time=4.0)
    run_to(swarm, 60)
    assert swarm.session.world.first_detection is not None
    for i in (1, 2, 3, 4):
        swarm.robots[i].pump()
    state = told_by(swarm, 1, 0)
    assert state.detected_at > 100.0
    assert swarm.session.world.t < 4.0


def test_a_slow_world_changes_nothing_of_the_truth() -> None:
    plain = run_in_memory(near_the_plume(topology="ring", max_time=2.0))
    slow = run_in_memory(near_the_plume(topology="ring", max_time=2.0, faults=(WorldSlow(pause=1.0),)))
    assert slow.digest == plain.digest


def test_a_fault_that_never_begins_changes_nothing() -> None:
    plain = run_in_memory(near_the_plume(topology="ring", max_time=2.0))
    late = (Loss(probability=1.0, at=5.0), Sensor(robot=0, which="position", how="stuck", at=5.0), Crash(robot=1, at=9.0))
    faulty = run_in_memory(near_the_plume(topology="ring", max_time=2.0, faults=late))
    assert faulty.digest == plain.digest
    assert faulty.faults == ()


@pytest.mark.parametrize("number", range(12))
def test_random_schedules_end_with_an_outcome_and_repeat_to_the_bit(number: int) -> None:
    scenario = random_scenario(number, max_time=3.0)
    first, second = run_in_memory(scenario), run_in_memory(scenario, wire=True)
    assert first.digest == second.digest
    assert first.faults == second.faults
    assert first.ended in ("time out", "found", "all robots have stopped, as planned")
