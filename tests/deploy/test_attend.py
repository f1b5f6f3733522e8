"""The launcher between the start of the processes and the outcome: what it does when the world's last word is not heard."""

import subprocess
import sys

import msgspec
import pytest
from swarm_helpers import near_the_plume

from deploy.launch.attend import Attendant
from deploy.launch.children import Child, Children
from deploy.memory_run import run_in_memory
from protocol import keys
from protocol.errors import SwarmFailure


class Nobody:
    """A watcher that nothing is told of, and a bus that nothing comes from."""

    def publisher(self, key, *, reliable):
        return lambda message: None

    def receive(self, timeout):
        return None

    def links(self):
        return frozenset()

    def progress(self, message):
        raise AssertionError

    def event(self, message):
        raise AssertionError


@pytest.fixture
def scenario():
    return near_the_plume(robots=1, max_time=0.5)


def attendant(scenario, folder, status):
    world = subprocess.Popen([sys.executable, "-c", f"raise SystemExit({status})"], stdin=subprocess.PIPE)
    world.wait(timeout=30.0)
    children = Children(folder, {keys.WORLD: Child(keys.WORLD, world, folder / "world.err")})
    return Attendant(Nobody(), scenario, children, Nobody(), lambda name: None), children


def test_outcome_that_was_told_while_the_link_was_down_is_read_from_the_folder(scenario, tmp_path):
    outcome = run_in_memory(scenario)
    (tmp_path / "outcome.json").write_bytes(msgspec.json.encode(outcome))
    launcher, children = attendant(scenario, tmp_path, 0)
    try:
        assert launcher.attend() == outcome
    finally:
        children.end(0.0)


@pytest.mark.parametrize(("status", "words"), [(0, "the world ended without an outcome."), (3, "world ended with status 3")])
def test_world_that_ended_without_an_outcome_is_a_failure(scenario, tmp_path, status, words):
    launcher, children = attendant(scenario, tmp_path, status)
    try:
        with pytest.raises(SwarmFailure, match=words):
            launcher.attend()
    finally:
        children.end(0.0)
