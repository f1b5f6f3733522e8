"""The world's side of real time, step by step: nobody is waited for."""

import pytest

from protocol.messages import Drive, Reading
from protocol.scenario.load import load_scenario
from world_server.realtime_session import RealtimeWorldSession
from world_server.world import World


class Story:
    def __init__(self, **values: object) -> None:
        chosen = {"robots": 3, "clock": "realtime", "plume.warm_up": 0.0, "max_time": 100.0, **values}
        scenario = load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])
        self.readings: list[Reading] = []
        self.texts: list[str] = []
        self.halts: list[str] = []
        self.session = RealtimeWorldSession(
            World(scenario),
            dict.fromkeys(range(3), self.readings.append),
            lambda halt: self.halts.append(halt.reason),
            lambda event: self.texts.append(event.text),
        )
        self.session.start()

    @property
    def tick(self) -> int:
        return self.session.world.tick

    def speed(self, robot: int) -> float:
        return self.session.world.bodies.robots[robot].nu

    def step(self, *robots: int, ticks: int = 1, torque: float = 0.1) -> None:
        """Steps before each of which `robots` answer."""
        for _ in range(ticks):
            for i in robots:
                assert self.session.take_drive(Drive(i, self.tick, torque, torque)) is False
            self.readings.clear()
            self.session.step()


def test_the_world_steps_although_nobody_answers_and_counts_whom_it_missed():
    story = Story()
    story.step(0, 1, ticks=4)
    assert story.tick == 4
    assert story.session.missed == [0, 0, 4]
    assert sorted(r.robot for r in story.readings) == [0, 1, 2]


def test_the_newest_drive_counts_until_it_is_too_old_and_then_the_robot_brakes():
    story = Story()
    story.step(0, 1, 2, ticks=3)
    before = story.speed(2)
    story.step(0, 1, ticks=5, torque=0.0)
    assert story.session.braked == [False, False, False]
    assert story.speed(2) > before > 0.0
    story.step(0, 1, ticks=1, torque=0.0)
    assert story.session.braked == [False, False, True]
    story.step(0, 1, ticks=20, torque=0.0)
    assert story.speed(2) == pytest.approx(0.0, abs=1e-9)
    assert story.speed(0) == pytest.approx(before)
    story.step(2, ticks=2)
    assert story.session.braked[2] is False
    assert story.speed(2) > 0.0


def test_drives_that_are_old_double_or_of_the_future_are_dropped():
    story = Story()
    story.step(0, 1, 2, ticks=2)
    for tick in (1, 0, 2, 2, 3):
        story.session.take_drive(Drive(0, tick, 0.2, 0.2))
    assert story.session.dropped == 4


def test_a_lost_robot_brakes_at_once_and_drives_again_when_it_is_back():
    story = Story()
    story.step(0, 1, 2, ticks=10)
    story.session.lose(1)
    story.session.take_drive(Drive(1, story.tick, 0.2, 0.2))  # sent before it hung
    story.step(0, 2, ticks=20, torque=0.0)
    assert story.speed(1) == pytest.approx(0.0, abs=1e-9)
    assert story.session.missed == [0, 0, 0]
    assert sorted(r.robot for r in story.readings) == [0, 2]
    assert all(j != 1 for r in story.readings for j, _ in r.hears)
    story.session.see(1)
    story.step(0, 2)
    assert sorted(r.robot for r in story.readings) == [0, 1, 2]
    story.step(0, 1, 2, ticks=3)
    assert story.speed(1) > 0.0
    assert story.texts == ["robot 1 lost at 0.50 s", "robot 1 is back at 1.50 s"]
    assert list(story.session.faults) == story.texts


def test_a_run_without_any_robot_is_not_over_at_once():
    story = Story()
    for i in range(3):
        story.session.lose(i)
    story.step(ticks=5)
    assert story.session.ended is None
    story.session.see(0)
    story.step(0)
    assert story.session.missed == [0, 0, 0]


def test_readings_say_by_how_much_the_schedule_has_moved():
    story = Story()
    story.session.slip = 0.7
    story.step()
    assert {r.slip for r in story.readings} == {0.7}


def test_the_run_ends_in_time():
    story = Story(max_time=0.5)
    story.step(0, 1, 2, ticks=10)
    assert story.session.ended == "time out"
    assert story.halts == ["time out"]


def test_in_real_time_late_robots_count_with_their_last_word_and_lost_ones_do_not():
    story = Story(**{"declaration.stop": "declared"})
    session, here, there = story.session, (2.0, 0, 1.0, 1.0), (1.0, 1, 30.0, 4.0)

    def say(**words: tuple[float, int, float, float]) -> None:
        for name, record in words.items():
            session.take_drive(Drive(int(name[1]), story.tick, 0.0, 0.0, record))
        session.step()

    say(r0=here, r1=there)
    session.lose(1)
    assert session.declarations.of == {0: here}
    session.see(1)
    say(r2=here)
    assert session.ended is None  # 1 is there and has said nothing since
    say(r1=here)
    assert session.ended == "declared"
    assert story.halts == ["declared"]
