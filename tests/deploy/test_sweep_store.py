"""What is finished of a sweep stays finished: whatever is killed when, whatever becomes of the spec."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from sweep_helpers import plan_of, rows_of, short_spec

from deploy.sweep import rows as r
from deploy.sweep.lock import only_one
from deploy.sweep.plan import Job, Plan
from deploy.sweep.store import Store, aside_of, finished, forget, parts_of
from protocol.errors import ScenarioError


def row_of(job: Job, time: float = 1.0) -> r.Row:
    """A finished run that nobody ran."""
    measured = dict.fromkeys(r.MEASURED) | {
        "seed": job.scenario.seed, "scenario_digest": job.digest, "found": True, "time": time, "finder": 0,
        "first_detection": None, "min_pair_distance": 0.5, "distance_travelled": [1.0, 2.0],
        "estimate_error": [None, 3.0], "disagreement": None, "digest": "d", "ticks": 20, "wall_s": 0.1,
        "ended": "found", "version": "0",
    }  # fmt: skip
    return {"label": job.label, **job.values, **measured}


@pytest.fixture
def out(tmp_path):
    return tmp_path / "r.parquet"


@pytest.fixture
def plan(tmp_path):
    return plan_of(short_spec(tmp_path))


def opened(out: Path, plan: Plan) -> Store:
    parts_of(out).mkdir(exist_ok=True)
    return Store(out, plan)


def test_row_that_was_added_is_there_after_a_crash(out, plan):
    store = opened(out, plan)
    store.add(row_of(plan.jobs[4]))
    store.add(row_of(plan.jobs[1]))
    assert set(finished(out)) == {plan.jobs[4].digest, plan.jobs[1].digest}
    again = opened(out, plan)
    assert [row["scenario_digest"] for row in rows_of(out)] == [plan.jobs[1].digest, plan.jobs[4].digest]
    assert again.rows == {plan.jobs[n].digest: row_of(plan.jobs[n]) for n in (1, 4)}
    assert list(parts_of(out).iterdir()) == []


class Crash(BaseException):
    """The process is killed here."""


def test_crash_at_any_point_of_putting_together_loses_nothing(out, plan, tmp_path, monkeypatch):
    """A spec that has half of the rows: result, aside and parts are written and removed, one operation at a time."""
    half = plan_of(short_spec(tmp_path, seeds=2, name="half"))
    all_digests = {job.digest for job in plan.jobs}
    done = {"replace": os.replace, "unlink": Path.unlink}
    for crash_at in range(100):
        forget(out)
        store = opened(out, plan)
        for job in plan.jobs[:3]:
            store.add(row_of(job))
        store.compact()
        for job in plan.jobs[3:]:
            store.add(row_of(job))
        left = crash_at

        def step(name):
            def crash_or_do(*arguments, **options):
                nonlocal left
                left -= 1
                if left < 0:
                    raise Crash
                return done[name](*arguments, **options)

            return crash_or_do

        with monkeypatch.context() as patched:
            patched.setattr(os, "replace", step("replace"))
            patched.setattr(Path, "unlink", step("unlink"))
            try:
                Store(out, half)
                break
            except Crash:
                pass
        assert set(finished(out, aside=True)) == all_digests
        assert set(opened(out, plan).rows) == all_digests
        assert len(rows_of(out)) == len(all_digests)
    assert crash_at > 4
    assert set(finished(out)) == {job.digest for job in half.jobs}


@pytest.mark.parametrize("written", ["nothing", "half", "all"])
def test_interrupt_while_a_row_is_added_loses_nothing_and_leaves_nothing(out, plan, monkeypatch, written):
    store = opened(out, plan)
    write = r.write_table

    def interrupted(table, file, scratch):
        if written == "half":
            (scratch / f"{file.name}.tmp").write_bytes(b"half a row")
        elif written == "all":
            write(table, file, scratch)
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(r, "write_table", interrupted)
        with pytest.raises(KeyboardInterrupt):
            store.add(row_of(plan.jobs[0]))
    store.compact()
    assert rows_of(out) == [row_of(plan.jobs[0])]
    assert list(parts_of(out).iterdir()) == []


def test_part_that_is_not_complete_is_run_again(out, plan):
    store = opened(out, plan)
    store.add(row_of(plan.jobs[0]))
    store.add(row_of(plan.jobs[1]))
    part = parts_of(out) / f"{plan.jobs[0].digest}.parquet"
    part.write_bytes(part.read_bytes()[:100])
    (parts_of(out) / "x.parquet.tmp").write_bytes(b"half a row")
    assert set(opened(out, plan).rows) == {plan.jobs[1].digest}
    assert list(parts_of(out).iterdir()) == []


def test_changed_spec_ignores_rows_and_has_them_again_when_it_is_changed_back(out, plan, tmp_path):
    store = opened(out, plan)
    for job in plan.jobs:
        store.add(row_of(job))
    store.compact()
    shorter = plan_of(short_spec(tmp_path, seeds=2))
    store = opened(out, shorter)
    assert (len(store.rows), store.ignored) == (4, 2)
    assert len(rows_of(out)) == 4
    assert len(rows_of(aside_of(out))) == 2
    store = opened(out, plan)
    assert (len(store.rows), store.ignored) == (6, 0)
    assert not aside_of(out).exists()
    assert rows_of(out) == [row_of(job) for job in plan.jobs]


def test_reused_rows_get_the_columns_of_the_spec_as_it_is_now(out, plan, tmp_path):
    store = opened(out, plan)
    store.add(row_of(plan.jobs[0]))
    labelled = plan_of(short_spec(tmp_path, more="\n[[cells]]\nlabel = 'usual'\nwind.gain = 0.15\n"))
    opened(out, labelled)
    (row,) = rows_of(out)
    assert (row["label"], row["wind.gain"]) == ("usual", 0.15)


def test_rows_keep_their_types_and_every_digit(out, plan):
    store = opened(out, plan)
    row = row_of(plan.jobs[0], time=0.1 + 0.2)
    store.add(row)
    store.compact()
    assert rows_of(out) == [row]
    schema = r.read_table(out).schema
    assert {name: schema.field(name).type for name in r.MEASURED} == r.MEASURED


def test_file_that_is_no_result_is_refused_and_left_alone(out, plan):
    out.write_text("hello")
    with pytest.raises(ScenarioError, match=r"r.parquet: it is not a Parquet file"):
        opened(out, plan)
    assert out.read_text() == "hello"
    r.write_table(r.make_table([{"other": 1}], {}), out, out.parent)
    with pytest.raises(ScenarioError, match='it has no column "label"'):
        opened(out, plan)


def test_second_holder_of_the_lock_is_refused_with_the_first_ones_number(tmp_path, out):
    folder = tmp_path / "r.parts"
    with only_one(folder, out):
        who = rf"another sweep \(process {os.getpid()}\) writes it now"
        with pytest.raises(ScenarioError, match=who), only_one(folder, out):
            pass
        assert (folder / "lock").exists()
    assert not folder.exists()
    with only_one(folder, out):
        pass


def test_lock_dies_with_its_process(tmp_path, out):
    folder = tmp_path / "r.parts"
    code = (
        "import sys, pathlib; from deploy.sweep.lock import only_one\n"
        "with only_one(pathlib.Path(sys.argv[1]), pathlib.Path('x')): print('held', flush=True); sys.stdin.read()"
    )
    holder = subprocess.Popen(
        [sys.executable, "-c", code, str(folder)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    try:
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(ScenarioError, match=f"process {holder.pid}"), only_one(folder, out):
            pass
    finally:
        holder.kill()
        holder.communicate()
    assert (folder / "lock").exists()
    with only_one(folder, out):
        pass


def test_list_values_of_a_grid_become_text_columns(tmp_path):
    plan = plan_of(short_spec(tmp_path, more="grid.search.target = [[80, 50], [70, 40]]\n"))
    assert {json.loads(job.values["search.target"])[0] for job in plan.jobs} == {80.0, 70.0}
