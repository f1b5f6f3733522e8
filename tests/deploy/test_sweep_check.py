"""`odourswarm sweep --check`: every run of a sweep is looked at, and the row says what was kept."""

from __future__ import annotations

import json
from types import SimpleNamespace

import pytest
from swarm_helpers import near_the_plume
from sweep_helpers import command, rows_of, short_spec

from deploy.checkers import check
from deploy.checkers.check import check_run, read_memory
from deploy.memory_run import run_in_memory
from deploy.sweep import kept
from deploy.sweep.kept import kept_of
from deploy.sweep.worker import _checked, _plain
from protocol.history.file import HistoryMemory
from protocol.scenario.faults import Liar


@pytest.mark.processes
def test_rows_of_a_checked_sweep_say_that_promises_were_kept_and_unchecked_runs_are_run_again(tmp_path):
    file, out = short_spec(tmp_path, seeds=2), tmp_path / "r.parquet"
    assert command(file, "--out", out, "--json", "--jobs", 1).exit_code == 0
    plain = rows_of(out)
    assert {(row["kept"], row["broken"]) for row in plain} == {(None, None)}

    checked = command(file, "--out", out, "--json", "--check", "--jobs", 1)
    report = json.loads(checked.stdout)
    assert (checked.exit_code, report["ran"], report["reused"]) == (0, 4, 0)
    assert [(cell["checked"], cell["kept"], cell["broken"]) for cell in report["cells"]] == [(2, 2, "")] * 2
    assert {(row["kept"], row["broken"]) for row in rows_of(out)} == {(True, "")}
    assert [row["digest"] for row in rows_of(out)] == [row["digest"] for row in plain]

    again = json.loads(command(file, "--out", out, "--json", "--check", "--jobs", 1).stdout)
    assert (again["ran"], again["reused"]) == (0, 4)
    assert "2 of 2" in command(file, "--out", out, "--summary").stdout


def test_a_broken_promise_is_named_and_the_outcome_is_there_all_the_same(monkeypatch):
    scenario = near_the_plume(robots=2, topology="line", max_time=1.0)
    monkeypatch.setattr(check, "unplanned", lambda _: [SimpleNamespace(name="order"), SimpleNamespace(name="hull")])
    answer = _checked(scenario)
    assert answer.broken == "order"
    assert answer.outcome.digest == _plain(scenario).outcome.digest
    assert _plain(scenario).broken is None


def test_what_a_liar_is_meant_to_break_is_not_held_against_the_run():
    scenario = near_the_plume(robots=3, max_time=2.0, faults=(Liar(robot=1, lies="position", offset=(3.0, 0.0)),))
    histories = HistoryMemory()
    run_in_memory(scenario, history=histories)
    assert [finding.name for finding in check_run(read_memory(histories)) if not finding.passed] == ["honesty"]
    assert _checked(scenario).broken == ""


def test_a_cell_counts_its_broken_promises_and_leaves_out_what_was_not_checked():
    rows = [{"kept": True, "broken": ""}, {"kept": False, "broken": "order"}, {"kept": None, "broken": None}, {}]
    cell = kept_of(rows)
    assert (cell.checked, cell.kept, cell.broken) == (2, 1, (("order", 1),))
    assert kept.fields(cell) == ["1 of 2 (order 1)"]
    assert kept_of(rows[2:]) is None


@pytest.mark.parametrize("arguments", [["--check"], ["faults", "--check", "--summary"]])
def test_check_needs_runs_to_look_at(arguments):
    result = command(*arguments)
    assert result.exit_code == 2
    assert "--check looks at runs while they are made" in result.output
