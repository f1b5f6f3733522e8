"""One robot in real time, told reading by reading with times given by hand."""

import msgspec
import pytest

from protocol.messages import Drive, Reading, Shared
from protocol.scenario import robot_view
from protocol.scenario.load import load_scenario
from robot_agent.agent import Agent
from robot_agent.lateness import Lateness
from robot_agent.realtime_session import RealtimeRobotSession

PERIOD = 0.05


class Heard(Agent):
    """An agent that says what it was given."""

    def __init__(self, view) -> None:
        super().__init__(view)
        self.decisions: list[int] = []
        self.used: list[tuple[int, int]] = []
        self.notes: list[tuple[float, ...]] = []

    def sense(self, reading: Reading) -> Shared:
        shared = super().sense(reading)
        if self.decision_due:
            self.decisions.append(reading.tick)
        return shared

    def act(self, heard) -> Drive:
        heard = list(heard)
        self.used = [(s.robot, s.tick) for s in heard]
        self.notes = [s.notes for s in heard]
        return super().act(heard)


class Robot:
    def __init__(self, **values: object) -> None:
        chosen = {"robots": 3, "topology": "line", "clock": "realtime", **values}
        scenario = load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])
        self.agent = Heard(robot_view(scenario, 1))
        self.told: list[Shared] = []
        self.drives: list[Drive] = []
        self.session = RealtimeRobotSession(
            self.agent, self.told.append, self.drives.append, period=PERIOD, late=0.25, ahead=10
        )

    def reading(self, tick: int, hears=None, **more) -> None:
        hears = ((0, tick), (2, tick)) if hears is None else hears
        self.session.take_reading(Reading(1, tick, tick * PERIOD, 60.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, hears, **more))

    def state(self, robot: int, tick: int, **more) -> None:
        one = Shared(robot, tick, 50.0, 3.0 * robot, *[0.0] * 4, -1.0, -1.0, *[0.0] * 3, -1, 0, *[0.0] * 4)
        self.session.take_shared(msgspec.structs.replace(one, **more))

    def respond(self, tick: int, late: float = 0.0) -> bool:
        return self.session.respond(100.0 + tick * PERIOD + late)


def test_a_reading_is_answered_at_once_with_what_is_there():
    robot = Robot()
    robot.reading(0)
    assert robot.respond(0)
    assert [d.tick for d in robot.drives] == [0]
    assert robot.agent.used == []
    robot.state(0, 0)
    robot.reading(1)
    assert robot.respond(1)
    assert robot.agent.used == [(0, 0)]
    assert robot.session.missed == 0


def test_without_a_new_reading_nothing_is_said():
    robot = Robot()
    robot.state(0, 0)
    assert not robot.respond(0)
    robot.reading(0)
    robot.respond(0)
    assert not robot.respond(1)
    assert len(robot.told) == len(robot.drives) == 1


def test_the_newest_reading_counts_and_the_skipped_ones_are_missed_periods():
    robot = Robot()
    for tick in (0, 1, 2, 3):
        robot.reading(tick)
    robot.respond(3)
    robot.reading(2)  # overtaken on the way
    assert not robot.respond(4)
    for tick in (4, 5, 6):
        robot.reading(tick)
    robot.respond(6)
    assert [d.tick for d in robot.drives] == [3, 6]
    assert robot.session.missed == 2
    assert robot.session.dropped == 1


def test_a_decision_whose_instant_was_skipped_is_made_at_the_next_reading():
    robot = Robot()
    for tick in (0, 1, 18, 23, 24, 39, 40, 41, 85):
        robot.reading(tick)
        robot.respond(tick)
    assert robot.agent.decisions == [0, 23, 40, 85]


def test_the_wind_before_the_start_is_not_lost_with_the_first_reading():
    robot = Robot()
    given = []
    robot.agent._decision.prefill = given.append
    robot.reading(0, wind_past=((1.0, 0.0), (1.0, 0.1)))
    robot.reading(1)
    robot.respond(1)
    assert [len(reading.wind_past) for reading in given] == [2]


def test_a_late_reading_keeps_a_safe_stop_and_a_prompt_one_ends_it():
    robot = Robot()
    for tick in range(5):
        robot.reading(tick)
        robot.respond(tick)
    robot.reading(5)
    assert not robot.respond(5, late=0.3)
    assert robot.session.stopped
    robot.reading(12)
    assert robot.respond(12, late=0.01)
    assert not robot.session.stopped
    assert [d.tick for d in robot.drives] == [0, 1, 2, 3, 4, 12]
    assert robot.session.missed == 1 + 6


def test_a_world_that_moves_its_schedule_makes_no_reading_late():
    robot = Robot()
    robot.reading(0)
    robot.respond(0)
    robot.reading(1, slip=3.0)
    assert robot.respond(1, late=3.0)


def test_what_the_radio_does_not_let_through_is_not_heard():
    robot = Robot()
    robot.reading(0, hears=((0, 0),))
    robot.respond(0)
    robot.state(0, 0)
    robot.state(2, 0)
    robot.reading(1, hears=())
    robot.respond(1)
    assert robot.agent.used == [(0, 0)]
    robot.reading(2, hears=((2, 0),))  # late by two ticks
    robot.respond(2)
    assert robot.agent.used == [(2, 0)]


def test_a_state_that_the_radio_lets_through_twice_is_heard_twice():
    robot = Robot()
    robot.state(0, 0)
    for tick in (0, 1):
        robot.reading(tick, hears=((0, 0),))
        robot.respond(tick)
        assert robot.agent.used == [(0, 0)]


def test_what_skipped_readings_let_through_is_heard():
    robot = Robot()
    for tick in (0, 1, 2):
        robot.reading(tick)
        robot.state(0, tick)
    robot.respond(2)
    assert robot.agent.used == [(0, 0), (0, 1), (0, 2)]


def test_a_silent_neighbour_is_left_out_when_its_state_is_stale_and_nobody_waits():
    robot = Robot()
    for tick in range(15):
        robot.reading(tick)
        robot.state(0, tick)
        if tick == 0:
            robot.state(2, tick)
        robot.respond(tick)
    assert [s.robot for _, s in robot.agent._neighbours.fresh] == [0]
    assert len(robot.drives) == 15


def test_states_from_a_far_future_twice_or_long_ago_are_dropped():
    robot = Robot()
    robot.reading(100)
    robot.respond(100)
    for tick in (111, 10**9, 3, 100, 100):
        robot.state(0, tick)
    assert robot.session.dropped == 4


def test_notes_of_a_decision_reach_a_robot_that_decides_later():
    robot = Robot(algorithm="ppso-im")
    robot.state(0, 0, notes=(0.0, 1.0, 2.0, 3.0))
    robot.state(0, 1)
    robot.reading(1, hears=((0, 0), (0, 1)))
    robot.respond(1)
    assert robot.agent.notes == [(0.0, 1.0, 2.0, 3.0)] * 2


@pytest.mark.parametrize("offset", [-7.0, 0.0, 1e6])
def test_lateness_needs_no_common_clock(offset):
    lateness = Lateness(PERIOD)
    late = {3: 0.02, 7: 0.4}
    found = [lateness.of(k, 0.0, offset + k * PERIOD + late.get(k, 0.0)) for k in range(10)]
    assert found == pytest.approx([late.get(k, 0.0) for k in range(10)], abs=1e-6)
