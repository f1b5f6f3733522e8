"""The committed studies of chapter 2 and of the rivals are complete and ask for what the thesis ran."""

from __future__ import annotations

from pathlib import Path

import deploy
from deploy.sweep.plan import make_plan
from deploy.sweep.spec import read_spec

STUDIES = Path(deploy.__file__).parent / "studies"


def test_chapter_2_runs_ten_algorithms_by_four_group_sizes_by_three_winds_until_enough_odour_is_met():
    plan = make_plan(read_spec(STUDIES / "chapter-2.toml"))
    assert len(plan.jobs) == 10 * 4 * 3 * 50
    assert {job.scenario.source.stop for job in plan.jobs} == {"concentration"}
    assert {job.scenario.source.stop_concentration for job in plan.jobs} == {19515.0}
    assert {job.scenario.max_time for job in plan.jobs} == {2500.0}
    direct = {job.scenario.pso.sampling for job in plan.jobs if job.scenario.algorithm in ("pso", "cpso")}
    assert direct == {10.0, 20.0, 30.0}


def test_rivals_run_beside_the_algorithms_of_the_thesis_until_somebody_is_at_the_source():
    plan = make_plan(read_spec(STUDIES / "rivals.toml"))
    assert len(plan.jobs) == 11 * 4 * 10
    assert {job.scenario.source.stop for job in plan.jobs} == {"circle"}
    assert {(job.scenario.max_time, job.scenario.case, job.scenario.topology) for job in plan.jobs} == {(1500.0, 1, "all")}
