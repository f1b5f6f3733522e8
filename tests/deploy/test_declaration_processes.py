"""Real robots declare the source over real links: the same end as in memory, and the recording holds their maps."""

from __future__ import annotations

import pytest
from recorder_helpers import Read
from swarm_helpers import near_the_plume

from deploy.launch.swarm import SwarmRun
from deploy.memory_run import run_in_memory
from deploy.recorder.layers.maps import ALL

pytestmark = pytest.mark.processes


class Listener:
    def __init__(self) -> None:
        self.texts: list[str] = []

    def progress(self, progress) -> None:
        """Not looked at."""

    def event(self, event) -> None:
        self.texts.append(event.text)


def test_a_swarm_over_zenoh_declares_what_it_declares_in_memory_and_shows_its_maps(tmp_path) -> None:
    places = [[24.0, float(y)] for y in (-4, -2, 0, 2, 4)]
    scenario = near_the_plume(
        algorithm="plume-map", topology="line", declaration__stop="declared", start__positions=places, max_time=200.0,
        network__lease_ms=3000,  # on a crowded machine a process may be held up while all start
    )
    listener = Listener()
    file = tmp_path / "run.rrd"
    outcome = SwarmRun("declares", scenario, file).execute(listener)
    again = run_in_memory(scenario)
    assert outcome.ended == "declared"
    assert (outcome.digest, outcome.declared_at, outcome.declared_by) == (again.digest, again.declared_at, again.declared_by)
    assert (outcome.declared_x, outcome.declared_y) == (again.declared_x, again.declared_y)
    assert not outcome.false_declaration
    assert outcome.messages["refused"] == 0
    assert "all robots declare the same place" in listener.texts
    assert len(Read(file).rows(f"/{ALL}", "EncodedImage:blob")) > 5
