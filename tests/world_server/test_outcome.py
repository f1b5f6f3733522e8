"""The outcome of a run, from what the robots reported at its end."""

import pytest

from protocol.bus import Counters
from protocol.messages import Report
from protocol.scenario.load import load_scenario
from world_server.outcome import outcome
from world_server.session import WorldSession
from world_server.world import World


def ended_with(*estimates):
    """The outcome when robot i's last word was the i-th estimate; None: it had none."""
    session = WorldSession(World(load_scenario(None)), {}, lambda halt: None, lambda event: None, {}, lambda inject: None)
    for i, estimate in enumerate(estimates):
        h_x, h_y = estimate or (0.0, 0.0)
        session.reports[i] = Report(i, h_x, h_y, estimate is not None, 0, 0, 0, 0)
    return outcome(session, "test", 1.0, Counters())


def test_disagreement_is_the_largest_distance_of_two_estimates():
    assert ended_with((10.0, 0.0), None, (13.0, 4.0), (11.0, 0.0)).disagreement == pytest.approx(5.0)


def test_who_has_no_estimate_disagrees_with_nobody():
    assert ended_with((40.0, 30.0), None, None).disagreement is None
    assert ended_with(None, None).disagreement is None
    assert ended_with((3.0, 4.0), (3.0, 4.0)).disagreement == 0.0
