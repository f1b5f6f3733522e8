"""Histories: they change nothing, a kill -9 leaves what was finished, and they are read in sentences."""

import json

import pytest
from history_helpers import kept
from swarm_helpers import near_the_plume
from typer.testing import CliRunner

from deploy.checkers.check import check_run, read_folder
from deploy.cli.app import app
from deploy.memory_run import run_in_memory
from protocol.errors import ScenarioError
from protocol.history.file import HistoryFolder, HistoryMemory, framed, records_in, whole_bytes
from protocol.history.records import Begin, Mind, Sent, Verdict


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The history of a short run."""
    folder = tmp_path_factory.mktemp("run") / "history"
    histories = HistoryFolder(folder)
    run_in_memory(near_the_plume(max_time=3.0), history=histories)
    histories.close()
    return folder


def copied(folder, tmp_path, **changed):
    for file in folder.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    return tmp_path


@pytest.mark.parametrize("algorithm", ["cfpso", "dcs", "ftmcs", "lpso", "cpso-s-c"])
def test_a_history_changes_nothing_and_is_the_same_through_the_codec(algorithm):
    scenario = near_the_plume(algorithm=algorithm, plume__warm_up=60.0, max_time=2.0)
    plain = run_in_memory(scenario)
    by_reference, through_codec = HistoryMemory(), HistoryMemory()
    assert run_in_memory(scenario, history=by_reference).digest == plain.digest
    assert run_in_memory(scenario, wire=True, history=through_codec).digest == plain.digest
    assert by_reference.members == through_codec.members


def test_a_folder_holds_what_memory_holds(folder):
    memory = HistoryMemory()
    run_in_memory(near_the_plume(max_time=3.0), history=memory)
    files = {file.stem.replace("-", "/"): file.read_bytes() for file in folder.iterdir()}
    assert files == memory.members


def test_everybody_writes_what_it_did(folder):
    history = read_folder(folder)
    assert sorted(history.lives) == [0, 1, 2, 3, 4]
    assert [state.tick for state in history.lives[3][0].sent] == list(range(60))
    assert [act.tick for act in history.lives[3][0].acted] == list(range(60))
    assert [moved.tick for moved in history.moved] == list(range(61))
    assert history.told[7].hears[0] == (0, ((1, 0), (4, 0)))
    assert history.verdicts == [Verdict(60, "time out")]
    assert history.results[0].ended == "time out"


@pytest.mark.parametrize("torn", [1, 4, 7, 8, 9, 30])
def test_a_torn_record_at_the_end_is_skipped(folder, tmp_path, torn):
    copied(folder, tmp_path)
    file = tmp_path / "robot-1.history"
    whole = list(records_in(file.read_bytes(), "it"))
    last = framed(whole[-1])
    file.write_bytes(file.read_bytes()[: -min(torn, len(last) - 1)])
    assert list(records_in(file.read_bytes(), "it")) == whole[:-1]


def test_who_begins_again_cuts_off_what_was_torn_and_goes_on(folder, tmp_path):
    copied(folder, tmp_path)
    file = tmp_path / "robot-1.history"
    file.write_bytes(file.read_bytes()[:-5])
    histories = HistoryFolder(tmp_path)
    write = histories.member("robot/1")
    write(Begin(1, "memory", "robot/1", b"", True))
    write(Sent(90, 1, 0.0, 0.0, (0.0, 0.0), False))
    histories.close()
    first, second = read_folder(tmp_path).lives[1]
    assert len(first.acted) == 59
    assert [state.tick for state in second.sent] == [90]


def test_a_world_that_went_back_to_a_checkpoint_is_read_as_it_went_on(folder, tmp_path):
    copied(folder, tmp_path)
    history = read_folder(folder)
    histories = HistoryFolder(tmp_path)
    write = histories.member("world")
    first = next(iter(records_in((folder / "world.history").read_bytes(), "it")))
    write(first)
    for moved in history.moved[40:50]:
        write(moved)
    histories.close()
    again = read_folder(tmp_path)
    assert [moved.tick for moved in again.moved] == list(range(50))
    assert max(again.told) == 40


def test_what_changes_at_decisions_only_is_filled_in(folder):
    minds = [act.mind for act in read_folder(folder).lives[0][0].acted]
    assert all(isinstance(mind, Mind) for mind in minds)
    written = [r for r in records_in((folder / "robot-0.history").read_bytes(), "it") if getattr(r, "mind", None)]
    assert len(written) < 10


def test_garbage_never_reads_as_whole():
    assert whole_bytes(b"") == whole_bytes(b"\xff" * 100) == whole_bytes(b"\x01") == 0


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda f: (f / "world.history").unlink(), "the world's history is not there"),
        (lambda f: [file.unlink() for file in f.iterdir()], "there is no history in it"),
        (lambda f: (f / "robot-2.history").write_bytes(_flipped(f / "robot-2.history")), "is damaged"),
        (lambda f: (f / "robot-2.history").write_bytes(framed(Verdict(1, "x"))), "not a history of this version"),
        (lambda f: (f / "robot-2.history").write_bytes(framed(Begin(1, "other", "robot/2", b"", True))), "memory, other"),
    ],
)
def test_a_folder_that_is_no_history_is_refused_in_a_sentence(folder, tmp_path, spoil, words):
    spoil(copied(folder, tmp_path))
    with pytest.raises(ScenarioError, match=words):
        read_folder(tmp_path)


def _flipped(file):
    data = bytearray(file.read_bytes())
    data[100] ^= 1
    return bytes(data)


def test_the_command_says_kept_and_its_status_is_0(folder):
    result = CliRunner().invoke(app, ["check", str(folder)])
    assert result.exit_code == 0
    assert "only neighbours' states were used" in result.stdout
    assert "BROKEN" not in result.stdout


def test_the_command_tells_the_counterexample_and_its_status_is_1(folder, tmp_path):
    copied(folder, tmp_path)
    (tmp_path / "robot-4.history").unlink()
    result = CliRunner().invoke(app, ["check", str(tmp_path)])
    assert result.exit_code == 1
    assert "conservation: robot 0 heard a state of robot 4 of tick 0 at tick 0 (0.00 s), but robot 4 never sent one." in (
        result.stdout
    )
    found = json.loads(CliRunner().invoke(app, ["check", str(tmp_path), "--json"]).stdout)
    assert found["passed"] is False
    assert [f["name"] for f in found["findings"] if not f["passed"]] == ["conservation"]


def test_the_command_refuses_what_is_no_history_with_status_2(tmp_path):
    assert CliRunner().invoke(app, ["check", str(tmp_path)]).exit_code == 2


def test_a_run_refuses_a_folder_that_has_a_history(folder):
    result = CliRunner().invoke(app, ["run", "--bus", "memory", "--history", str(folder)])
    assert result.exit_code == 2


def test_a_run_killed_in_the_middle_has_no_verdict_and_breaks_nothing_else(folder, tmp_path):
    """Everything was written before it was sent: cut all files off at any tick and only the verdict is missing."""
    history, _ = kept(near_the_plume(max_time=3.0))
    history.verdicts.clear()
    history.results.clear()
    del history.moved[41:]
    for lives in history.lives.values():
        del lives[0].acted[40:]
        del lives[0].sent[41:]
    assert [f.name for f in check_run(history) if not f.passed] == ["verdict"]
