"""A world that was saved and made again goes on to the bit as if it had never stopped."""

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol.errors import SwarmFailure
from protocol.messages import Drive
from protocol.randomness import rng_for
from protocol.scenario import Scenario
from protocol.scenario.load import load_scenario
from world_server.snapshot import VERSION
from world_server.world import World


def scenario_of(seed: int, **values: object) -> Scenario:
    chosen: dict[str, object] = {
        "seed": seed, "robots": 3, "topology": "ring", "start.x": 60.0, "start.y": -4.0, "wind.gain": 1.0,
        "plume.warm_up": 60.0, "sensors.wind_history": 5, "wind.nodes": 7,
    }  # fmt: skip
    chosen |= values
    return load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])


def live_on(world: World, ticks: int) -> list[tuple[list, str]]:
    """Drive about for `ticks` ticks; what was read and the digest at each."""
    seen = []
    for _ in range(ticks):
        drives = {}
        for i in world.live:
            draws = rng_for(world.scenario.seed, "test drive", i, world.tick)
            drives[i] = Drive(i, world.tick, 1.6 * draws.uniform() - 0.8, 1.6 * draws.uniform() - 0.8)
        readings = world.step(world.t, world.next_t, drives)
        seen.append((readings, world.digest))
    return seen


@given(
    before=st.integers(0, 70),
    after=st.integers(1, 60),
    seed=st.integers(0, 2**31),
    ahead=st.integers(0, 20),
    lost=st.booleans(),
    growth=st.sampled_from(["farrell1", "printed", "farrell2"]),
    noise=st.sampled_from([0.0, 0.1]),
)
@settings(max_examples=12, deadline=None)
def test_a_restored_world_lives_on_as_the_one_that_was_saved(before, after, seed, ahead, lost, growth, noise):
    scenario = scenario_of(seed, **{"plume.growth": growth, "sensors.position_noise": noise})
    world = World(scenario)
    live_on(world, before)
    if lost:
        world.lose(1)
    world.prepare(ahead)
    snapshot = world.snapshot()
    again = World.restore(scenario, snapshot)
    assert again.readings() == world.readings()
    assert live_on(again, after) == live_on(world, after)
    assert again.snapshot() == world.snapshot()
    assert again.bodies.travelled.tolist() == world.bodies.travelled.tolist()
    assert again.verdict.min_pair_distance == world.verdict.min_pair_distance
    assert (again.first_detection, again.detections, again.found) == (world.first_detection, world.detections, world.found)


def test_saving_changes_nothing():
    left, right = World(scenario_of(5)), World(scenario_of(5))
    for _ in range(30):
        left.snapshot()
        assert live_on(left, 1) == live_on(right, 1)


def test_who_found_the_source_is_kept():
    world = World(scenario_of(1, **{"start.x": 10.0, "start.y": -1.0}))
    assert world.found is not None
    assert World.restore(world.scenario, world.snapshot()).found == world.found


def test_a_world_without_a_source_is_kept():
    world = World(scenario_of(1, **{"plume.release_rate": 0.0}))
    again = World.restore(world.scenario, world.snapshot())
    assert live_on(again, 25) == live_on(world, 25)


@pytest.mark.parametrize("snapshot", [b"", b"\x00", b"\x91\x07", msgspec.msgpack.encode([VERSION, 3]), b"junk" * 20])
def test_what_is_no_snapshot_is_refused_with_a_sentence(snapshot):
    with pytest.raises(SwarmFailure, match="version"):
        World.restore(scenario_of(0), snapshot)


def test_the_digest_tells_histories_apart_and_does_not_hang_on_who_looks():
    looked_at, alone, other = World(scenario_of(3)), World(scenario_of(3)), World(scenario_of(4))
    for world in (looked_at, alone, other):
        for _ in range(33):
            live_on(world, 1)
            if world is looked_at:
                assert world.digest == world.digest
    assert looked_at.digest == alone.digest != other.digest
