"""Processes that are killed and started again: robots rejoin, the world comes back to the bit, until they are given up."""

import os
import signal

import psutil
import pytest
from swarm_helpers import near_the_plume
from test_processes import ODOURSWARM, Swarm, folder, odourswarm, wait_for  # noqa: F401  # the fixture is used by all

from deploy.memory_run import run_in_memory
from protocol.errors import SwarmFailure

pytestmark = pytest.mark.processes
# A few robots, for every process has to start: the fewer there are, the less the machine has to do for the same story.
SLOW = {"robots": 4, "topology": "ring", "start__y": -30.0, "search__after": "stay"}  # the odour is met after some 500 ticks
FAR = SLOW | {"plume__release_rate": 0.0}  # there is nothing to find: it goes on until it is ended
AT_ONCE = {"supervision__restart": "always", "supervision__backoff": 0.05}  # test_policy.py has the pauses


def kill(swarm: Swarm, name: str) -> int:
    pid = swarm.pid(name)
    os.kill(pid, signal.SIGKILL)
    return pid


def back(swarm: Swarm, robot: int) -> list[str]:
    return [text for text in swarm.events if text.startswith(f"robot {robot} drives again")]


def test_killed_robot_is_started_again_and_rejoins_the_running_swarm():
    scenario = near_the_plume(**FAR, **AT_ONCE, max_time=1e5)
    with Swarm(scenario) as swarm:
        swarm.under_way()
        first = kill(swarm, "robot/2")
        wait_for(lambda: back(swarm, 2), "robot 2 drives again")
        assert swarm.pid("robot/2") != first
        kill(swarm, "robot/2")
        wait_for(lambda: len(back(swarm, 2)) == 2, "robot 2 drives again")
        wait_for(lambda: swarm.live == 4, "all robots take part")
        swarm.run.children.members["world"].process.terminate()  # ends it in good order
    assert swarm.error is None
    assert [fault.split(" at ")[0] for fault in swarm.outcome.faults] == ["robot 2 lost", "robot 2 is back"] * 2
    assert "robot 2 ended with signal 9 and is started again" in swarm.events
    assert not swarm.outcome.failed


def test_run_ends_as_usual_with_a_robot_that_was_started_again():
    # Long: on a busy machine the others do a thousand ticks and more while the new process starts.
    scenario = near_the_plume(topology="ring", seed=2, start__y=-45.0, max_time=400.0, supervision__restart="crashed")
    with Swarm(scenario) as swarm:
        swarm.under_way()
        kill(swarm, "robot/0")
        swarm.finish()
    assert swarm.error is None
    assert swarm.outcome.ended in ("found", "time out")
    assert back(swarm, 0)
    assert all(child.status == 0 for child in swarm.run.children.members.values())


def test_all_robots_killed_at_once_come_back():
    scenario = near_the_plume(**FAR | {"robots": 3}, **AT_ONCE, max_time=1e5)
    with Swarm(scenario) as swarm:
        swarm.under_way()
        for i in range(3):
            kill(swarm, f"robot/{i}")
        wait_for(lambda: all(back(swarm, i) for i in range(3)), "all robots drive again")
        swarm.run.children.members["world"].process.terminate()
    assert swarm.error is None
    assert swarm.outcome.ended == "interrupted"


def test_killed_world_comes_back_from_its_checkpoint_with_the_digest_of_an_undisturbed_run():
    """From its first life, from one that was a second life itself, and from a third."""
    scenario = near_the_plume(**SLOW, max_time=100.0, supervision__checkpoint_every=2.0)
    with Swarm(scenario) as swarm:
        for _ in range(3):
            seen = swarm.under_way().ticks
            wait_for(lambda seen=seen: swarm.ticks > seen + 70, "some ticks more")
            first = kill(swarm, "world")
            wait_for(lambda first=first: swarm.pid("world") != first, "the world is started again")
        swarm.finish()
    assert swarm.error is None
    assert sum("the world is back" in text for text in swarm.events) == 3
    assert swarm.outcome.faults == ()
    expected = run_in_memory(scenario)
    assert swarm.outcome.digest == expected.digest
    assert swarm.outcome.estimate_error == expected.estimate_error


def test_what_the_swarm_declares_is_the_same_when_a_robot_crashes_as_planned_and_the_world_is_killed():
    places = [[24.0, float(y)] for y in (-4, -2, 0, 2, 4)]
    crash = {"kind": "crash", "robot": 1, "at": 2.0, "restart": 2.0}
    scenario = near_the_plume(
        algorithm="plume-map", topology="ring", declaration__stop="declared", start__positions=places, max_time=300.0,
        supervision__checkpoint_every=2.0, faults=(crash,), declaration__radius=1.5, declaration__tolerance=1.5,
    )  # fmt: skip
    with Swarm(scenario) as swarm:
        wait_for(lambda: any("robot 1 is back" in text for text in swarm.events), "robot 1 is back")
        seen = swarm.under_way().ticks
        wait_for(lambda: swarm.ticks > seen + 70, "some ticks more")
        first = kill(swarm, "world")
        wait_for(lambda: swarm.pid("world") != first, "the world is started again")
        swarm.finish()
    assert swarm.error is None
    ended, expected = swarm.outcome, run_in_memory(scenario)
    assert expected.ended == "declared"
    assert (ended.ended, ended.digest, ended.declared_at) == (expected.ended, expected.digest, expected.declared_at)
    assert (ended.declared_by, ended.declared_x) == (expected.declared_by, expected.declared_x)


def test_robot_and_world_killed_together_both_come_back():
    scenario = near_the_plume(
        **FAR, **AT_ONCE, max_time=1e5, supervision__checkpoint_every=2.0
    )
    with Swarm(scenario) as swarm:
        swarm.under_way()
        kill(swarm, "world")
        kill(swarm, "robot/1")
        wait_for(lambda: any("the world is back" in text for text in swarm.events), "the world is back")
        wait_for(lambda: swarm.live == 4, "all robots take part")
        swarm.run.children.members["world"].process.terminate()
    assert swarm.error is None
    assert swarm.outcome.ended == "interrupted"


def test_planned_crash_with_restart_gives_the_same_truth_over_zenoh_and_in_memory():
    crash = {"kind": "crash", "robot": 1, "at": 2.0, "restart": 3.0}
    scenario = near_the_plume(topology="ring", robots=4, max_time=10.0, faults=(crash,))
    with Swarm(scenario) as swarm:
        swarm.finish()
    assert swarm.error is None
    expected = run_in_memory(scenario)
    assert swarm.outcome.digest == expected.digest
    assert swarm.outcome.faults == expected.faults
    assert any("robot 1 is back at 5.00 s" in fault for fault in swarm.outcome.faults)


def test_robot_that_ends_too_often_is_given_up_with_a_sentence_and_the_run_goes_on():
    scenario = near_the_plume(**FAR, **AT_ONCE, max_time=1e5, supervision__max_restarts=1)
    with Swarm(scenario) as swarm:
        swarm.under_way()
        kill(swarm, "robot/3")
        wait_for(lambda: back(swarm, 3), "robot 3 drives again")
        kill(swarm, "robot/3")
        wait_for(lambda: any("robot 3 is given up" in text for text in swarm.events), "robot 3 is given up")
        ticks = swarm.ticks
        wait_for(lambda: swarm.ticks > ticks + 20, "the others go on")
        swarm.run.children.members["world"].process.terminate()
    assert swarm.error is None
    assert not swarm.outcome.failed


def test_world_that_ends_too_often_ends_the_run_with_a_sentence():
    scenario = near_the_plume(
        **FAR | {"robots": 3}, max_time=1e5, supervision__checkpoint_every=2.0, supervision__max_restarts=1
    )
    with Swarm(scenario) as swarm:
        swarm.under_way()
        first = kill(swarm, "world")
        wait_for(lambda: swarm.pid("world") != first, "the world is started again")
        kill(swarm, "world")
    assert isinstance(swarm.error, SwarmFailure)
    assert "the world is given up: it ended with signal 9 and has been started again once" in str(swarm.error)


def test_launcher_killed_during_a_restart_leaves_nobody_behind(folder):  # noqa: F811
    process = odourswarm(
        "run", "--robots", "3", "--max-time", "5000", "--set", "search.after=stay", "--checkpoint-every", "5",
        "--restart", "always",
    )
    family: dict[int, psutil.Process] = {}

    def members() -> list[psutil.Process]:
        for child in psutil.Process(process.pid).children(recursive=True):
            family[child.pid] = child
        return list(family.values())

    wait_for(lambda: len(members()) == 4 and list(folder.glob("odour-*/*.checkpoint")), "the run has begun")
    wait_for(lambda: any(path.stat().st_size > 2000 for path in folder.glob("odour-*/*.journal")), "the run is under way")
    robots = [p for p in members() if "robot_agent" in p.cmdline()]
    world = next(p for p in members() if "world_server" in p.cmdline())
    for victim in (robots[0], robots[2], world):
        victim.kill()
    wait_for(lambda: len(members()) > 4, "somebody is started again")
    members()
    process.kill()
    process.communicate(timeout=60)
    wait_for(
        lambda: not any(p.is_running() and p.status() != psutil.STATUS_ZOMBIE for p in family.values()), "all have ended"
    )
    wait_for(lambda: not list(folder.glob("odour-*")), "the run's folder is gone")


@pytest.mark.parametrize("checkpoints", [False, True])
def test_hung_world_ends_the_run_or_is_started_again(checkpoints):
    values = {"supervision__checkpoint_every": 3.0} if checkpoints else {}
    scenario = near_the_plume(**FAR | {"robots": 3}, max_time=1e5, network__return_timeout=2.0, **values)
    with Swarm(scenario) as swarm:
        swarm.under_way()
        first = swarm.pid("world")
        os.kill(first, signal.SIGSTOP)
        if checkpoints:
            wait_for(lambda: swarm.pid("world") != first, "the world is started again")
            wait_for(lambda: any("the world is back" in text for text in swarm.events), "the world is back")
            swarm.run.children.members["world"].process.terminate()
        else:
            wait_for(lambda: swarm.error is not None, "the run is given up")
    if checkpoints:
        assert swarm.error is None
    else:
        assert "the world hangs" in str(swarm.error)
