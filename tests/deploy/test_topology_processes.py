"""Real processes on graphs that switch and that the range limits: the same truth as in memory."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from swarm_helpers import folder_left_clean, near_the_plume

from deploy.launch.swarm import SwarmRun
from deploy.memory_run import run_in_memory
from protocol.messages import Event, Progress

pytestmark = pytest.mark.processes

GRAPHS = {
    "switching": {"topology": [{"at": 0, "name": "line"}, {"at": 0.5, "name": "star"}], "graph_options__period": 1.0},
    "range-limited": {"topology": "range-limited", "graph_options__range": 7.0},
}


class Nobody:
    """Watches nothing."""

    def progress(self, progress: Progress) -> None: ...

    def event(self, event: Event) -> None: ...


@pytest.fixture(autouse=True)
def folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    with folder_left_clean(monkeypatch) as folder:
        yield folder


@pytest.mark.parametrize("graph", GRAPHS)
def test_truth_is_the_same_over_zenoh_and_in_memory(graph: str) -> None:
    scenario = near_the_plume(robots=4, algorithm="dcs", seed=8, max_time=10.0, **GRAPHS[graph])
    outcome = SwarmRun("test", scenario).execute(Nobody())
    expected = run_in_memory(scenario)
    assert outcome.digest == expected.digest
    assert outcome.estimate_error == expected.estimate_error
    assert outcome.messages["refused"] == outcome.messages["dropped"] == 0
