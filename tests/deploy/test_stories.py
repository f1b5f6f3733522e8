"""Stories told tick by tick in memory: loss, late messages, death, strangers."""

import msgspec
from hypothesis import given, settings
from hypothesis import strategies as st
from swarm_helpers import near_the_plume

from deploy.memory_run import MemorySwarm, run_in_memory
from protocol import keys
from protocol.codec import Codec
from protocol.messages import Drive, Reading, Report, Shared
from protocol.randomness import rng_for


class LossyRadio:
    """Loses every fourth state, and brings every fourth one three ticks late; repeatable."""

    def __init__(self, radio, seed: int, loss: float = 0.25, late: float = 0.25):
        self.radio, self.seed, self.loss, self.late = radio, seed, loss, late

    def hears(self, i, tick, live):
        heard = []
        for j, k in self.radio.hears(i, tick, live):
            draw = rng_for(self.seed, "link", i, j, k).uniform()
            if draw < self.late and k >= 3:
                heard.append((j, k - 3))
            elif draw >= self.late + self.loss:
                heard.append((j, k))
        return tuple(heard)


def finish(swarm: MemorySwarm) -> MemorySwarm:
    swarm.start()
    while not swarm.session.over:
        swarm.tick()
    return swarm


def test_loss_and_late_messages_hold_nobody_up_and_repeat_exactly():
    digests = []
    for _ in range(2):
        swarm = MemorySwarm(near_the_plume(topology="ring", seed=5))
        swarm.session.world.radio = LossyRadio(swarm.session.world.radio, seed=5)
        finish(swarm)
        assert swarm.session.ended == "time out"
        assert all(robot.session.dropped == 0 for robot in swarm.robots.values())
        digests.append(swarm.session.world.digest)
    assert digests[0] == digests[1]
    assert digests[0] != run_in_memory(near_the_plume(topology="ring", seed=5)).digest


def test_swarm_that_hears_half_of_everything_still_finds_the_source():
    scenario = near_the_plume(topology="ring", algorithm="cfpso", seed=2, max_time=300.0)
    swarm = MemorySwarm(scenario)
    swarm.session.world.radio = LossyRadio(swarm.session.world.radio, seed=2)
    assert finish(swarm).session.ended == "found"


def test_dead_robot_leaves_the_barrier_and_the_run_goes_on():
    swarm = MemorySwarm(near_the_plume(topology="ring"))
    swarm.start()
    for _ in range(30):
        swarm.tick()
    swarm.kill(2)
    while not swarm.session.over:
        swarm.tick()
    world = swarm.session.world
    assert swarm.session.ended == "time out"
    assert world.live == {0, 1, 3, 4}
    assert swarm.session.faults == ["robot 2 lost at 1.50 s"]
    assert world.bodies.nu[2] == 0.0
    assert 2 not in swarm.session.reports


def test_death_in_the_middle_of_a_tick_holds_up_neither_neighbours_nor_world():
    """Robot 2 has told one neighbour its state, not the other, and dies before it drives."""
    swarm = MemorySwarm(near_the_plume(topology="line"))
    swarm.start()
    for _ in range(10):
        swarm.tick()
    swarm.robots[2].alive = False  # takes no more part, like a process that hangs
    for i in (0, 1, 3, 4):
        swarm.robots[i].pump()
    tick = swarm.session.world.tick
    assert swarm.robots[1].session.waiting
    assert swarm.robots[3].session.waiting
    swarm.kill(2)  # its links are down: the lease is over
    swarm.tick()
    assert swarm.session.world.tick == tick + 1


def test_run_whose_robots_all_die_ends_as_a_failure():
    swarm = MemorySwarm(near_the_plume(robots=2, topology="line"))
    swarm.start()
    swarm.tick()
    for i in (0, 1):
        swarm.kill(i)
    while not swarm.session.over:
        swarm.tick()
    assert swarm.session.ended == "all robots are gone"


frames = st.binary(max_size=64)


@given(junk=st.lists(st.tuples(st.sampled_from(["reading", "shared", "drive", "report", "halt"]), frames), max_size=20))
@settings(max_examples=10, deadline=None)
def test_strangers_bytes_change_nothing_but_the_count(junk):
    scenario = near_the_plume(topology="ring", max_time=1.0)
    expected = run_in_memory(scenario).digest
    swarm = MemorySwarm(scenario, wire=True)
    swarm.start()
    for leaf, frame in junk:
        for i in range(5):
            key = keys.HALT if leaf == "halt" else keys.robot(i, leaf)
            swarm.network.inject(keys.robot_name(i), key, frame)
            swarm.network.inject(keys.WORLD, key, frame)
        swarm.tick()
    while not swarm.session.over:
        swarm.tick()
    assert swarm.session.world.digest == expected
    refused = sum(robot.bus.counters.refused for robot in swarm.robots.values()) + swarm.bus.counters.refused
    assert refused == 10 * len(junk)


def test_well_formed_messages_out_of_place_are_dropped():
    """Of another tick, from a robot that does not exist, twice, to the wrong robot."""
    scenario = near_the_plume(topology="ring", max_time=1.0)
    expected = run_in_memory(scenario).digest
    swarm = MemorySwarm(scenario, wire=True)
    codec = Codec(scenario.seed)
    swarm.start()
    for _ in range(5):
        swarm.tick()
    state = swarm.robots[1].session.agent.sense
    assert state is not None
    shared = Shared(1, 400, *([0.0] * 6), -1.0, -1.0, 0.0, 0.0, 0.0, 0, 0, 1.0, 0.0, 0.0, 0.0)
    reading = Reading(1, 3, 0.15, *([0.0] * 8))
    for message, key, member in [
        (shared, "robot/1/shared", "robot/0"),
        (msgspec.structs.replace(shared, tick=-70), "robot/1/shared", "robot/0"),
        (reading, "robot/0/reading", "robot/0"),
        (msgspec.structs.replace(reading, robot=0), "robot/0/reading", "robot/0"),
        (Drive(0, 2, 0.8, 0.8), "robot/0/drive", "world"),
        (Drive(77, 5, 0.8, 0.8), "robot/77/drive", "world"),
        (Report(0, 0.0, 0.0, False, 0, 0, 0, 0), "robot/0/report", "world"),
    ]:
        swarm.network.inject(member, key, codec.encode(message))
    while not swarm.session.over:
        swarm.tick()
    assert swarm.session.world.digest == expected
    assert swarm.robots[0].session.dropped == 4
    assert swarm.session.dropped == 3
