"""Lock-step over links that lose messages, as links do that come and go: it stands still, asks again, and nothing changes.

The clock is the test's own.
"""

import pytest
from swarm_helpers import near_the_plume

from deploy.memory_run import MemorySwarm, run_in_memory
from protocol.randomness import rng_for
from protocol.scenario.faults import HISTORY, Delay, Hang
from world_server.outcome import outcome
from world_server.stall import AGAIN, Stall

PATIENCE = 10.0  # s


class LossySwarm(MemorySwarm):
    """Each message that lock-step needs is lost with probability `loss`; `mute` robots say nothing from a tick on."""

    def __init__(self, scenario, loss, mute=()):
        super().__init__(scenario)
        self.loss, self.mute, self.lost = loss, dict(mute), 0
        self._draws = rng_for(scenario.seed, "lost messages")
        self.session._send = {i: self._leaky(i, send) for i, send in self.session._send.items()}
        for i, robot in self.robots.items():
            robot.session._tell = self._leaky(i, robot.session._tell)
            robot.session._drive = self._leaky(i, robot.session._drive)

    def _leaky(self, robot, publish):
        def perhaps(message):
            if self._draws.uniform() < self.loss or self.mute.get(robot, message.tick + 1) <= message.tick:
                self.lost += 1
            else:
                publish(message)

        return perhaps

    def to_the_end(self):
        """Run to the end; how often everybody waited for nothing."""
        session, stall, now, waits = self.session, Stall(PATIENCE), 0.0, 0
        self.start()
        while not session.over and waits < 100_000:
            before = session.world.tick
            self.tick()
            if session.world.tick == before and not any(robot.bus.inbox for robot in self.robots.values()):
                now, waits = now + 0.6 * AGAIN, waits + 1
                if stall.look(session, now):
                    session.step()
        assert session.over
        return outcome(session, self.run, 0.0, self.bus.counters), waits


@pytest.mark.parametrize("faults", [(), (Delay(delay=0.2, jitter=0.3), Hang(robot=2, at=1.0, until=2.0))])
def test_lost_messages_cost_time_and_nothing_else(faults):
    scenario = near_the_plume(topology="ring", seed=5, max_time=3.0, faults=faults)
    swarm = LossySwarm(scenario, loss=0.03)
    told, waits = swarm.to_the_end()
    assert swarm.lost > 5
    assert waits > 5
    assert told.digest == run_in_memory(scenario).digest


def test_a_robot_that_never_answers_is_done_without():
    scenario = near_the_plume(topology="ring", seed=5, max_time=2.0)
    told, waits = LossySwarm(scenario, loss=0.0, mute={3: 20}).to_the_end()
    assert waits > PATIENCE / AGAIN
    assert told.ended == "time out"
    assert any("robot 3 is done without: no answer for 10 s" in text for text in told.faults)


def test_readings_that_come_again_and_again_fill_nobodys_socket():
    swarm = MemorySwarm(near_the_plume(topology="ring", seed=5, max_time=10.0))
    swarm.start()
    while swarm.session.world.tick < 2 * HISTORY:
        swarm.tick()
    robot, told = swarm.robots[0], []
    robot.pump()
    robot.session._tell = told.append
    reading = next(reading for reading in swarm.session._readings if reading.robot == 0)
    for _ in range(round(PATIENCE / AGAIN)):
        robot.session.take_reading(reading)
    assert {state.tick for state in told} == set(range(HISTORY + 1, 2 * HISTORY + 1))
    assert len(told) < 200


def test_a_machine_that_was_asleep_costs_no_robot_its_place():
    session = MemorySwarm(near_the_plume(topology="ring", seed=5, max_time=2.0)).session
    stall = Stall(PATIENCE)
    session.start()
    for now in (0.0, 1000.0, 2000.0):
        assert not stall.look(session, now)
    assert session.world.live == set(range(5))
