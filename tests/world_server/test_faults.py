"""What each fault does to radio, sensors and wheels, one by one."""

from __future__ import annotations

from itertools import pairwise
from statistics import mean, stdev

import pytest

from protocol.messages import Reading
from protocol.scenario import Scenario
from protocol.scenario.faults import (
    HISTORY,
    Actuator,
    Crash,
    Delay,
    Duplicate,
    Fault,
    Hang,
    Loss,
    Partition,
    Reorder,
    Sensor,
    WorldSlow,
)
from protocol.scenario.load import load_scenario
from world_server.faults.actuator import ActuatorFaults
from world_server.faults.channel import Channel, channel_of
from world_server.faults.memory import recall, remember
from world_server.faults.plan import Plan
from world_server.faults.sensor import SensorFaults
from world_server.faults.slow import Slowness
from world_server.links import Links
from world_server.radio import Radio

TICKS = 400
Heard = dict[int, tuple[tuple[int, int], ...]]


def scenario(*faults: Fault, robots: int = 2, topology: str = "line") -> Scenario:
    given = {"robots": robots, "topology": topology, "faults": faults}
    return load_scenario(None, overrides=[(name, value, "test") for name, value in given.items()])


def heard(*faults: Fault, ticks: int = TICKS) -> Heard:
    """What robot 0 hears of robot 1, tick by tick."""
    channel = Channel(scenario(*faults))
    return {k: channel.heard(0, k, (1,), {}) for k in range(ticks)}


def test_a_run_without_faults_of_the_radio_has_no_channel() -> None:
    assert channel_of(scenario(Crash(robot=0))) is None


def test_a_channel_whose_faults_are_over_changes_nothing() -> None:
    assert heard(Loss(probability=1.0, at=1.0, until=2.0))[60] == ((1, 60),)


def test_loss_takes_its_share_and_only_while_it_lasts() -> None:
    got = heard(Loss(probability=0.3, at=1.0, until=16.0))
    lost = [k for k in range(TICKS) if not got[k]]
    assert all(20 <= k < 320 for k in lost)
    assert 0.2 < len(lost) / 300 < 0.4
    assert all(len(states) <= 1 and states in ((), ((1, k),)) for k, states in got.items())


def test_two_edges_are_lost_independently_and_an_edge_that_is_not_named_is_not_touched() -> None:
    channel = Channel(scenario(Loss(probability=0.5)))
    there = [bool(channel.heard(0, k, (1,), {})) for k in range(TICKS)]
    back = [bool(channel.heard(1, k, (0,), {})) for k in range(TICKS)]
    assert 0.4 < mean(a == b for a, b in zip(there, back, strict=True)) < 0.6
    named = Channel(scenario(Loss(probability=1.0, edges=((0, 1),))))
    assert named.heard(0, 5, (1,), {}) == ()
    assert named.heard(1, 5, (0,), {}) == ((0, 5),)


def test_a_constant_delay_brings_every_state_once_and_in_order() -> None:
    got = heard(Delay(delay=0.5))
    assert all(got[k] == (((1, k - 10),) if k >= 10 else ()) for k in range(TICKS))


def test_jitter_loses_nothing_and_keeps_within_its_bounds() -> None:
    got = heard(Delay(delay=0.2, jitter=0.6))
    late = {sent: k - sent for k, states in got.items() for _, sent in states}
    assert set(range(TICKS - 16)) <= late.keys()
    assert set(late.values()) <= set(range(4, 17))
    assert len(set(late.values())) > 8


def test_delays_that_add_up_beyond_a_robots_memory_lose_the_state() -> None:
    got = heard(Delay(delay=3.0), Delay(delay=3.0))
    assert all(states == () for states in got.values())
    assert all(k - sent <= HISTORY - 2 for k, states in heard(Delay(delay=3.1)).items() for _, sent in states)


def test_a_duplicate_comes_behind_the_newer_state() -> None:
    got = heard(Duplicate(probability=1.0, after=0.1))
    assert got[1] == ((1, 1),)
    assert got[50] == ((1, 50), (1, 48))


def test_an_overtaken_state_comes_behind_the_next_one() -> None:
    got = heard(Reorder(probability=0.3))
    for k in range(1, TICKS):
        newer, older = (1, k), (1, k - 1)
        assert got[k] in ((), (newer,), (older,), (newer, older))
        assert ((older in got[k]) + (older in got[k - 1])) == 1
    assert any(len(states) == 2 for states in got.values())


def test_a_partition_parts_the_groups_and_a_one_way_one_only_one_way() -> None:
    parted = Channel(scenario(Partition(groups=((0, 1), (2, 3))), robots=4, topology="all"))
    assert [parted.heard(i, 3, tuple(j for j in range(4) if j != i), {}) for i in range(4)] == [
        ((1, 3),), ((0, 3),), ((3, 3),), ((2, 3),),
    ]  # fmt: skip
    one_way = Channel(scenario(Partition(groups=((0,), (1,)), one_way=True)))
    assert one_way.heard(0, 3, (1,), {}) == ()
    assert one_way.heard(1, 3, (0,), {}) == ((0, 3),)


@pytest.mark.parametrize("stopped", [0, 1])
def test_what_was_under_way_to_or_from_a_robot_that_stops_is_never_heard(stopped: int) -> None:
    declared = scenario(Delay(delay=0.5))
    radio = Radio(declared, Links(declared))
    for k in range(100):
        live = {0, 1} if not 30 <= k < 35 else {0, 1} - {stopped}
        if k == 35:
            radio.admit(stopped, k)
        got = radio.hears(0, k, live) if 0 in live else ()
        expected = ((1, k - 10),) if 10 <= k < 30 or k >= 45 else ()
        assert got == expected, k


def test_a_state_is_not_heard_that_was_sent_while_the_link_was_closed() -> None:
    channel = Channel(scenario(Delay(delay=0.5)))
    got = {k: channel.heard(0, k, () if 30 <= k < 40 else (1,), {}) for k in range(80)}
    assert all(not 30 <= sent < 40 for states in got.values() for _, sent in states)
    assert got[55] == ((1, 45),)


def reading(tick: int, value: float = 100.0, robot: int = 0) -> Reading:
    return Reading(robot, tick, 0.05 * tick, value, value, 1.0, 0.0, 0.0, 2.0, 3.0, value)


def observed(fault: Sensor, ticks: int = 200) -> list[Reading]:
    faults = SensorFaults(scenario(fault))
    return [faults.observe(reading(k, 100.0 + k)) for k in range(ticks)]


def test_a_stuck_sensor_keeps_the_first_value_of_the_fault_and_then_comes_back() -> None:
    got = observed(Sensor(robot=0, which="concentration", how="stuck", at=1.0, until=2.0))
    values = [r.concentration for r in got]
    assert values[:20] == [100.0 + k for k in range(20)]
    assert set(values[20:40]) == {120.0}
    assert values[40] == 140.0
    assert got[30].x == 130.0


def test_a_biased_sensor_adds_and_never_shows_less_than_no_odour() -> None:
    assert observed(Sensor(robot=0, which="wind", how="bias", value=0.5))[3].wind_x == 2.5
    assert observed(Sensor(robot=0, which="concentration", how="bias", value=-1e4))[3].concentration == 0.0
    assert observed(Sensor(robot=1, which="wind", how="bias", value=0.5))[3] == reading(3, 103.0)


def test_a_noisy_sensor_has_the_noise_that_was_asked_for() -> None:
    errors = [r.theta - 1.0 for r in observed(Sensor(robot=0, which="heading", how="noise", value=0.2), 1000)]
    assert abs(mean(errors)) < 0.03
    assert 0.17 < stdev(errors) < 0.23


def test_a_sensor_that_drops_out_reads_nothing_and_odometry_stays_where_it_was() -> None:
    assert {r.concentration for r in observed(Sensor(robot=0, which="concentration", how="dropout"))} == {0.0}
    xs = [r.x for r in observed(Sensor(robot=0, which="position", how="dropout", value=0.5))]
    held = sum(a == b for a, b in pairwise(xs))
    assert 70 < held < 130
    assert all(x <= 100.0 + k for k, x in enumerate(xs))


def test_a_weak_wheel_gives_its_share_of_what_the_motor_can_give() -> None:
    faults = ActuatorFaults(scenario(Actuator(robot=1, wheel="left", strength=0.5, until=1.0)))
    left, right = [0.4, 5.0], [0.4, 5.0]
    faults.weaken(3, left, right)
    assert left == [0.4, 0.4]
    assert right == [0.4, 0.8]
    left = [0.4, 5.0]
    faults.weaken(20, left, right)
    assert left == [0.4, 5.0]


def test_a_slow_world_sleeps_while_it_lasts() -> None:
    slow = Slowness(scenario(WorldSlow(pause=0.25, at=1.0, until=2.0), WorldSlow(pause=0.5, at=1.5)))
    assert [slow.pause(k) for k in (19, 20, 30, 40)] == [0.0, 0.25, 0.75, 0.5]


def test_the_plan_says_who_stops_and_who_comes_back() -> None:
    plan = Plan(scenario(Hang(robot=0, at=1.0, until=2.0), Crash(robot=1, at=2.0)))
    assert plan.at(19) is None
    assert plan.at(20).stops == [(0, "hang")]
    assert plan.at(40).stops == [(1, "crash")]
    assert plan.at(40).back == [0]
    assert plan.returns_after(39)
    assert not plan.returns_after(40)


def test_what_faults_remember_goes_through_a_snapshot() -> None:
    both = scenario(Delay(delay=0.5), Sensor(robot=0, which="position", how="stuck"))

    def made() -> tuple[Radio, SensorFaults]:
        return Radio(both, Links(both)), SensorFaults(both)

    radio, sensors = made()
    for k in range(40):
        radio.hears(0, k, {0, 1})
        sensors.observe(reading(k, float(k)))
    radio.admit(1, 32)
    again, sensors_again = made()
    recall(remember(radio, sensors), again, sensors_again)
    assert sensors_again.observe(reading(40)) == sensors.observe(reading(40))
    assert [again.hears(0, k, {0, 1}) for k in range(40, 60)] == [radio.hears(0, k, {0, 1}) for k in range(40, 60)]
