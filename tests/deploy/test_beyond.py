"""`odourswarm reproduce beyond`: paired numbers against some made by hand, and where its runs come from."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest
import typer
from sweep_helpers import plan_of, write_spec
from typer.testing import CliRunner

from deploy.cli.reproduce import reproduce
from deploy.reproduce.beyond import runs as source
from deploy.reproduce.beyond.gains import result_of
from deploy.reproduce.beyond.paired import compare
from deploy.reproduce.beyond.runs import few_of
from deploy.sweep.plan import make_plan
from deploy.sweep.rows import MEASURED, make_table, read_table, write_table
from deploy.sweep.studies import find_spec
from deploy.sweep.summary import summarise

app = typer.Typer()
app.command()(reproduce)


def run(algorithm: str, seed: int, time: float | None, *, gain: float = 0.15, case: int = 1) -> dict:
    """A finished run; without a time it found nothing."""
    return dict.fromkeys(MEASURED) | {
        "label": algorithm, "algorithm": algorithm, "wind.gain": gain, "case": case, "seed": seed, "max_time": 1000.0,
        "found": time is not None, "time": 1000.0 if time is None else time, "version": "0",
        "scenario_digest": f"{algorithm} {gain} {case} {seed}",
    }  # fmt: skip


OURS = [run("plume-map", seed, 100.0 + seed) for seed in range(8)]
THEIRS = [run("cfpso", seed, time) for seed, time in enumerate([150.0, 151.0, 152.0, 153.0, 154.0, 155.0, 100.0, None])]


def test_the_difference_is_taken_plume_by_plume() -> None:
    pair = compare([*OURS, *THEIRS], "plume-map", "cfpso")
    assert (pair.plumes, pair.faster, pair.slower) == (8, 7, 1)
    assert pair.saved == (6 * 50.0 - 6.0 + 893.0) / 8  # a run that found nothing counts with max_time
    assert pair.interval[0] < pair.saved < pair.interval[1]
    assert pair.sign == pytest.approx(2 * (1 + 8) / 2**8)  # none or one of eight coins, on either side


def test_plumes_that_only_one_met_do_not_count() -> None:
    more = [run("cfpso", 99, 1.0), run("plume-map", 98, 1.0), run("cfpso", 3, 1.0, case=2), run("cfpso", 3, 1.0, gain=2.0)]
    assert compare([*OURS, *THEIRS, *more], "plume-map", "cfpso") == compare([*OURS, *THEIRS], "plume-map", "cfpso")
    assert compare([*OURS, *more], "plume-map", "dcs") is None


def test_the_order_of_the_rows_changes_nothing() -> None:
    rows = [*OURS, *THEIRS]
    random.Random(1).shuffle(rows)
    assert compare(rows, "plume-map", "cfpso") == compare([*OURS, *THEIRS], "plume-map", "cfpso")


def test_the_other_way_round_the_sign_turns() -> None:
    one, other = (compare([*OURS, *THEIRS], *names) for names in (("plume-map", "cfpso"), ("cfpso", "plume-map")))
    assert (one.saved, one.faster, one.sign, one.wilcoxon) == (-other.saved, other.slower, other.sign, other.wilcoxon)


def test_algorithms_that_are_alike_differ_by_chance_only() -> None:
    alike = compare([*OURS, *(row | {"algorithm": "cfpso"} for row in OURS)], "plume-map", "cfpso")
    assert (alike.saved, alike.faster, alike.slower, alike.sign, alike.wilcoxon) == (0.0, 0, 0, 1.0, 1.0)
    lone = compare([OURS[0], THEIRS[0]], "plume-map", "cfpso")
    assert (lone.plumes, lone.interval) == (1, None)


def test_many_plumes_tell_a_difference_that_few_do_not() -> None:
    times = [(100.0 + k % 7, 110.0 + k % 11) for k in range(60)]
    rows = [run(name, k, t[n]) for k, t in enumerate(times) for n, name in enumerate(("plume-map", "cfpso"))]
    assert compare(rows, "plume-map", "cfpso").wilcoxon < 1e-6
    assert compare(rows[:6], "plume-map", "cfpso").wilcoxon > 0.05


def test_result_has_every_cell_with_the_intervals_of_the_sweep() -> None:
    rows = [*OURS, *THEIRS, *(run("plume-map", seed, 200.0, gain=2.0) for seed in range(3))]
    numbers = result_of(rows).numbers
    cells = {(cell["gain"], cell["algorithm"]): cell for cell in numbers["cells"]}
    assert list(cells) == [(0.15, "plume-map"), (0.15, "cfpso"), (2.0, "plume-map")]
    (summary,) = summarise(THEIRS, [])
    assert cells[0.15, "cfpso"]["found_share_95"] == summary.interval
    assert cells[0.15, "cfpso"]["median_time_95_s"] == summary.median_interval
    assert [(pair["gain"], pair["rival"]) for pair in numbers["pairs"]] == [(0.15, "cfpso")]


def write(file: Path, rows: list[dict]) -> Path:
    write_table(make_table(rows, {}), file, file.parent)
    return file


def command(*arguments: object):
    return CliRunner().invoke(app, ["beyond", *map(str, arguments)])


def test_a_sweeps_result_becomes_a_picture_and_numbers(tmp_path) -> None:
    file = write(tmp_path / "beyond.parquet", [*OURS, *THEIRS])
    shown = command("--result", file, "--out", tmp_path / "out", "--json")
    assert shown.exit_code == 0
    facts = json.loads(shown.stdout)
    assert facts["numbers"]["pairs"][0]["faster"] == 7
    assert (tmp_path / "out" / "beyond.png").read_bytes().startswith(b"\x89PNG")
    words = " ".join(command("--result", file, "--out", tmp_path / "out").stdout.split())
    assert "plume-map and cfpso on the same plumes at gain 0.15" in words
    assert "87.5 % found" in words


def test_a_result_that_is_not_there_or_another_is_refused(tmp_path) -> None:
    absent = command("--result", tmp_path / "no.parquet", "--out", tmp_path)
    assert absent.exit_code == 2
    assert "there are no finished runs; `odourswarm sweep beyond --out" in absent.stderr
    rows = [{key: value for key, value in row.items() if key != "wind.gain"} for row in OURS]
    other = command("--result", write(tmp_path / "other.parquet", rows), "--out", tmp_path)
    assert other.exit_code == 2
    assert 'has no column "wind.gain"' in other.stderr


def test_a_few_runs_are_the_studys_own_each_with_a_seed_and_the_cases_in_turn() -> None:
    plan = make_plan(find_spec("beyond"))
    few = few_of(plan, 3)
    assert {(job.scenario.case, job.scenario.seed) for job in few.jobs} == {(1, 41000), (2, 41001), (3, 41002)}
    assert len(few.jobs) == 3 * 4 * 4
    assert {job.digest for job in few.jobs} <= {job.digest for job in plan.jobs}


def test_without_a_result_a_few_runs_are_made_and_kept(tmp_path, monkeypatch) -> None:
    text = 'seeds = {first = 3, count = 4}\nrobots = 2\ntopology = "line"\nmax_time = 0.5\nplume.warm_up = 20\n'
    text += 'wind.nodes = 11\n[grid]\nalgorithm = ["plume-map", "cfpso"]\ncase = [1, 2]\nwind.gain = [0.15, 1.0]\n'
    plan = plan_of(write_spec(tmp_path, text))
    monkeypatch.setattr(source, "make_plan", lambda spec: plan)
    monkeypatch.setattr(source, "RESULT", tmp_path / "beyond.parquet")
    facts = json.loads(command("--out", tmp_path, "--json").stdout)
    assert sum(cell["runs"] for cell in facts["numbers"]["cells"]) == source.FEW * 2 * 2
    assert read_table(tmp_path / "beyond.parquet").num_rows == source.FEW * 2 * 2
    more = json.loads(command("--out", tmp_path, "--seeds", 3, "--json").stdout)
    assert sum(cell["runs"] for cell in more["numbers"]["cells"]) == 3 * 2 * 2
    assert json.loads(command("--out", tmp_path, "--json").stdout) == more


@pytest.mark.parametrize("name", ["beyond", "plume-map-graphs", "plume-map-sizes"])
def test_the_studies_are_right(name: str) -> None:
    plan = make_plan(find_spec(name))
    assert plan.spec.seeds == 50
    assert "plume-map" in {job.scenario.algorithm for job in plan.jobs}
