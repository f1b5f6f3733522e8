"""Planned faults of real processes: the same truth as in memory, and nobody is left behind.

Every wait is for a condition with a deadline; the deadlines are generous, because machines are slow and noisy.
"""

import threading

import psutil
import pytest
from swarm_helpers import folder_left_clean, near_the_plume

from deploy.launch.swarm import SwarmRun
from deploy.memory_run import run_in_memory
from protocol.messages import Event, Outcome, Progress
from protocol.scenario import Scenario
from protocol.scenario.faults import Crash, Delay, Fault, Hang, Liar, Loss, WorldSlow

pytestmark = pytest.mark.processes
DEADLINE = 120.0


class Ear:
    """Hears what the run says, and looks at its processes when a robot stops."""

    def __init__(self, run: SwarmRun) -> None:
        self.run = run
        self.seen: dict[str, set[str]] = {}  # member -> states in which its process was seen

    def progress(self, progress: Progress) -> None:
        for name, child in self.run.children.members.items():
            if child.status is None:
                self.seen.setdefault(name, set()).add(psutil.Process(child.process.pid).status())

    def event(self, event: Event) -> None:
        """Told again in the outcome."""


@pytest.fixture(autouse=True)
def folder(monkeypatch):
    with folder_left_clean(monkeypatch) as folder:
        yield folder


def run_over_zenoh(scenario: Scenario) -> tuple[Outcome, Ear]:
    run = SwarmRun("faults", scenario)
    ear = Ear(run)
    ended: list[Outcome | BaseException] = []

    def execute() -> None:
        try:
            ended.append(run.execute(ear))
        except BaseException as error:
            ended.append(error)

    thread = threading.Thread(target=execute, daemon=True)
    thread.start()
    thread.join(DEADLINE)
    assert ended, "the run did not end"
    assert isinstance(ended[0], Outcome), ended[0]
    return ended[0], ear


def compared(*faults: Fault, **values: object) -> Ear:
    """Run over processes and in memory; the two must be the same."""
    scenario = near_the_plume(topology="ring", seed=5, faults=faults, **values)
    outcome, ear = run_over_zenoh(scenario)
    expected = run_in_memory(scenario)
    assert outcome.faults == expected.faults
    assert outcome.digest == expected.digest
    assert outcome.estimate_error == expected.estimate_error
    assert outcome.ended == expected.ended
    return ear


def test_loss_delay_hang_crash_and_a_liar_give_the_truth_of_a_run_in_memory():
    compared(
        Loss(probability=0.3),
        Delay(delay=0.2, jitter=0.3, edges=((0, 1), (2, 1))),
        Hang(robot=2, at=1.0, until=2.5),
        Hang(robot=1, at=2.0, until=2.5),
        Crash(robot=3, at=2.5),
        Liar(robot=4, offset=(20.0, 10.0)),
        max_time=5.0,
    )


def test_a_robot_that_hangs_longer_than_its_lease_is_really_stopped_and_links_up_again():
    ear = compared(Hang(robot=2, at=1.0, until=3.0), WorldSlow(pause=0.05, until=3.0), max_time=4.0)
    assert psutil.STATUS_STOPPED in ear.seen["robot/2"]
    assert psutil.STATUS_STOPPED not in ear.seen["robot/1"]


def test_neighbours_of_a_long_hang_are_not_stopped_by_a_full_socket():
    compared(Hang(robot=2, at=1.0, until=31.0), start__y=-45.0, max_time=32.0)


def test_a_robot_that_hangs_to_the_end_is_not_left_behind():
    ear = compared(Hang(robot=1, at=0.5), max_time=1.5)
    assert ear.run.children.members["robot/1"].status is not None
