"""Sweeps as real processes: what they find, and every way in which they can be stopped."""

import json
import os
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import psutil
import pytest
from sweep_helpers import DEADLINE, REPOSITORY, Quiet, command, plan_of, rows_of, short_spec, start_sweep, wait_for

from deploy.memory_run import run_in_memory
from deploy.sweep.execute import PAUSE, execute
from deploy.sweep.store import parts_of
from deploy.sweep.workers import TRIES, Workers

pytestmark = pytest.mark.processes


def measured(row):
    """A row but for what the wall clock says."""
    return {name: value for name, value in row.items() if name != "wall_s"}


def workers_of(process: subprocess.Popen) -> list[psutil.Process]:
    return [p for p in psutil.Process(process.pid).children(recursive=True) if "deploy.sweep.worker" in p.cmdline()]


def all_gone(processes: list[psutil.Process]) -> bool:
    return not any(p.is_running() and p.status() != psutil.STATUS_ZOMBIE for p in processes)


def parts(out: Path) -> list[Path]:
    return list(parts_of(out).glob("*.parquet"))


def test_rows_are_the_same_with_one_and_two_processes_and_in_this_one(tmp_path):
    file = short_spec(tmp_path, seeds=2)
    one, two = tmp_path / "one.parquet", tmp_path / "two.parquet"
    ended = command(file, "--out", one, "--jobs", 1, "--json")
    report = json.loads(ended.stdout)
    assert (ended.exit_code, report["runs"], report["ran"], report["failed"]) == (0, 4, 4, [])
    assert [cell["runs"] for cell in report["cells"]] == [2, 2]
    assert command(file, "--out", two, "--jobs", 2).exit_code == 0
    assert [measured(row) for row in rows_of(one)] == [measured(row) for row in rows_of(two)]
    plan = plan_of(file)
    for job, row in zip(plan.jobs, rows_of(one), strict=True):
        outcome = run_in_memory(job.scenario)
        assert row["scenario_digest"] == outcome.scenario_digest == job.digest
        for name in ("digest", "time", "found", "ticks", "first_detection", "min_pair_distance", "seed", "ended"):
            assert row[name] == getattr(outcome, name)
        assert row["distance_travelled"] == list(outcome.distance_travelled)
        assert row["estimate_error"] == list(outcome.estimate_error)
    assert sorted(tmp_path.iterdir()) == sorted([file, one, two])


def test_killed_sweep_goes_on_where_it_was_and_leaves_nobody(tmp_path):
    file, out = short_spec(tmp_path, seeds=20), tmp_path / "r.parquet"
    sweep = start_sweep(file, "--out", out, "--jobs", 2)
    wait_for(lambda: len(parts(out)) >= 3, "three runs are finished")
    workers = workers_of(sweep)
    sweep.kill()
    sweep.communicate()
    assert len(workers) == 2
    wait_for(lambda: all_gone(workers), "no worker outlives the sweep")
    kept = {row["scenario_digest"]: row for part in parts(out) for row in rows_of(part)}
    assert 3 <= len(kept) < 40

    plan = plan_of(file)
    report = execute(plan, out, 2, Quiet())
    assert (report.reused, report.ran, len(report.rows)) == (len(kept), 40 - len(kept), 40)
    rows = {row["scenario_digest"]: row for row in rows_of(out)}
    assert list(rows) == [job.digest for job in plan.jobs]
    # Not run again: even what the wall clock said is the same.
    assert {digest: rows[digest] for digest in kept} == kept
    assert not parts_of(out).exists()
    again = execute(plan, out, 2, Quiet())
    assert (again.reused, again.ran) == (40, 0)


HOLDER = """
import sys
from pathlib import Path
from deploy.sweep.plan import make_plan
from deploy.sweep.spec import read_spec
from deploy.sweep.workers import Workers

with Workers(2) as workers:
    for _ in workers.run(make_plan(read_spec(Path(sys.argv[1]))).jobs, 0.01):
        if sum(member.job is not None for member in workers._members) == 2:
            print(*(member.process.pid for member in workers._members), flush=True)
            sys.stdin.read()
"""


def test_worker_ends_in_the_middle_of_an_endless_run_when_the_sweep_is_killed(tmp_path):
    endless = "plume.release_rate = 0\n"
    file = short_spec(tmp_path, seeds=1, more=endless)
    file.write_text(file.read_text().replace("max_time = 1\n", "max_time = 1e6\n"))
    command = [sys.executable, "-c", HOLDER, str(file)]
    with subprocess.Popen(command, cwd=REPOSITORY, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as holder:
        workers = [psutil.Process(int(pid)) for pid in holder.stdout.readline().split()]
        try:
            holder.kill()
            wait_for(lambda: all_gone(workers), "no worker outlives the sweep", deadline=20.0)
        finally:
            for worker in workers:
                with suppress(psutil.NoSuchProcess):
                    worker.kill()
    assert len(workers) == 2


@pytest.mark.parametrize("stop", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_sweep_puts_its_rows_together_and_leaves_nobody(tmp_path, stop):
    file, out = short_spec(tmp_path, seeds=50), tmp_path / "r.parquet"
    sweep = start_sweep(file, "--out", out, "--jobs", 2, start_new_session=True)
    wait_for(lambda: len(parts(out)) >= 2, "two runs are finished")
    workers = workers_of(sweep)
    if stop == signal.SIGINT:
        os.killpg(sweep.pid, stop)  # as a terminal does: everyone gets it
    else:
        sweep.send_signal(stop)
    stdout, stderr = sweep.communicate(timeout=DEADLINE)
    assert sweep.returncode == 130
    assert stdout == ""
    assert stderr.splitlines()[-1] == (
        f"interrupted; {out} has what was finished, the same command goes on from there."
    )
    assert len(workers) == 2
    wait_for(lambda: all_gone(workers), "no worker outlives the sweep")
    assert 2 <= len(rows_of(out)) < 100
    assert not parts_of(out).exists()


def test_second_sweep_of_the_same_result_is_refused_while_the_first_goes_on(tmp_path):
    file, out = short_spec(tmp_path, seeds=50), tmp_path / "r.parquet"
    sweep = start_sweep(file, "--out", out, "--jobs", 1)
    try:
        wait_for(lambda: (parts_of(out) / "lock").exists() and bool(workers_of(sweep)), "the sweep is at work")
        second = command(file, "--out", out)
        assert second.exit_code == 2
        assert second.stderr == (
            f"{out}: another sweep (process {sweep.pid}) writes it now; wait for its end, or give this one --out FILE.\n"
        )
        wait_for(lambda: len(parts(out)) >= 1, "the first goes on")
        seen = json.loads(command("--summary", file, "--out", out, "--json").stdout)
        assert seen["finished"] >= 1
        assert seen["finished"] + seen["missing"] == 100
    finally:
        sweep.terminate()
        sweep.communicate()


def test_run_whose_worker_died_is_run_once_more(tmp_path):
    plan = plan_of(short_spec(tmp_path, seeds=10))
    with Workers(1) as workers:
        done = []
        for result in workers.run(plan.jobs, PAUSE):
            if result is not None:
                done.append(result)
                if len(done) == 3:
                    (member,) = workers._members
                    member.process.kill()
    assert sorted(result.job.digest for result in done) == sorted(job.digest for job in plan.jobs)
    assert all(result.outcome is not None for result in done)
    assert workers.lost == 1


def test_run_that_kills_its_workers_is_given_up_and_the_others_go_on(tmp_path):
    plan = plan_of(short_spec(tmp_path, seeds=4))
    doomed = plan.jobs[1].digest
    with Workers(2) as workers:
        done = []
        for result in workers.run(plan.jobs, 0.001):
            if result is not None:
                done.append(result)
            for member in workers._members:
                if member.job is not None and member.job.digest == doomed:
                    member.process.kill()
        left = [member.process for member in workers._members]
    failed = [result for result in done if result.outcome is None]
    assert [(result.job.digest, result.error) for result in failed] == [
        (doomed, "its process died 2 times (SIGKILL); fewer --jobs leave each more memory.")
    ]
    assert workers.lost == TRIES
    assert len(done) == len(plan.jobs)
    assert all(process.returncode is not None for process in left)


def test_failed_run_is_reported_tried_again_and_not_in_the_result(tmp_path):
    """A wind that the grid cannot carry is only found out while it blows."""
    file = short_spec(tmp_path, seeds=1, more="grid.wind.nodes = [11, 201]\nwind.diffusivity = 2000\n")
    out = tmp_path / "r.parquet"
    ended = command(file, "--out", out, "--json")
    report = json.loads(ended.stdout)
    assert ended.exit_code == 3
    assert (report["finished"], len(report["failed"])) == (2, 2)
    assert all(failure["why"].startswith("one wind step of 0.1 s needs") for failure in report["failed"])
    assert ended.stderr.count("one wind step of 0.1 s needs") == 1  # said once, not for every run
    assert {row["wind.nodes"] for row in rows_of(out)} == {11}
    assert "the same command tries them again" in ended.stderr
