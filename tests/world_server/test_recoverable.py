"""A session that is built again from its snapshot and its journal is where the one that was killed had been."""


from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from test_snapshot import scenario_of

from protocol.messages import Drive, Linked
from protocol.randomness import rng_for
from protocol.scenario import Scenario, linked_to, scenario_digest
from world_server.checkpoints import Checkpoints
from world_server.recoverable import RecoverableSession
from world_server.world import World


class Told:
    """A session's outside: what it says, by kind."""

    def __init__(self, scenario: Scenario, kept: Checkpoints | None, saved=None, *, patient: bool = False):
        self.said: list[object] = []
        n = range(scenario.robots)
        world = World(scenario) if saved is None else World.restore(scenario, saved[0].world)
        publish = dict.fromkeys(n, self.said.append)
        say = self.said.append
        journal = kept.note if kept is not None else lambda _: None
        self.session = RecoverableSession(world, publish, say, say, publish, say, journal, patient=patient)
        if saved is not None:
            self.session.restore(saved[0].session, saved[1])


def drive(session: RecoverableSession) -> None:
    """Let everybody who takes part answer, and those who are called say that they are there."""
    world = session.world
    for i in sorted(session.awaited):
        for j in range(world.scenario.robots):
            session.take_linked(Linked(j, world.tick if j == i else -1, linked_to(world.scenario.graph, j)))
        session.admit(i)
    complete = session.idle
    for i in sorted(world.live):
        draws = rng_for(1, "test drive", i, world.tick)
        complete = session.take_drive(Drive(i, world.tick, 0.8 * draws.uniform(), 0.8 * draws.uniform()))
    if complete:
        session.step()


FAULTS = (
    {"kind": "crash", "robot": 0, "at": 0.5, "restart": 0.6},
    {"kind": "hang", "robot": 2, "at": 1.4, "until": 1.9},
    {"kind": "delay", "delay": 0.2, "jitter": 0.1},
    {"kind": "sensor", "robot": 1, "which": "wind", "how": "stuck", "at": 0.3},
)


@given(
    saved_at=st.integers(0, 40), killed_after=st.integers(0, 30), lost_at=st.integers(0, 60),
    faults=st.booleans(), mid_tick=st.booleans(),
)  # fmt: skip
@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_killed_session_goes_on_to_the_bit(tmp_path, saved_at, killed_after, lost_at, faults, mid_tick):
    scenario = scenario_of(4, **({"faults": FAULTS} if faults else {}))
    kept = Checkpoints(tmp_path / "kept", "run", scenario_digest(scenario))
    first = Told(scenario, kept).session
    first.start()

    def live(session: RecoverableSession, until: int) -> None:
        while session.world.tick < until:
            if session.world.tick == lost_at and 1 in session.world.live and session.lose(1):
                session.step()
            if session.world.tick == lost_at + 9 and 1 not in session.world.live:
                session.come(1)
            drive(session)

    live(first, saved_at)
    while not first.quiet:
        drive(first)
    kept.write(first.world.tick, first.world.snapshot(), first.snapshot(), 1.5)
    live(first, first.world.tick + killed_after)
    if mid_tick and first.world.live:  # some have answered already: they answer again
        i = min(first.world.live)
        first.take_drive(Drive(i, first.world.tick, 9.0, 9.0))
        first._drives.clear()
    again = Checkpoints(tmp_path / "kept", "run", scenario_digest(scenario))
    told = Told(scenario, again, again.load())
    second = told.session
    assert told.said == []
    assert second.world.snapshot() == first.world.snapshot()
    assert (second.faults, second.stopped, second.awaited) == (first.faults, first.stopped, first.awaited)
    second.go_on()
    end = first.world.tick + 40
    live(first, end)
    live(second, end)
    assert second.world.digest == first.world.digest
    assert second.faults == first.faults
    kept.close(remove=False)
    again.close(remove=True)
    assert list((tmp_path / "kept").iterdir()) == []
