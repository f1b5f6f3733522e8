"""What happens to a recording when processes, disks and viewers fail; real processes, awaited with a deadline."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from recorder_helpers import Read, messages, record

from deploy.recorder.mend import QUIET, mend, whole_length

HELPERS = Path(__file__).with_name("recorder_helpers.py")
ROOT = HELPERS.parents[2]
DEADLINE = 60.0  # s


def start(story: str, path: Path) -> subprocess.Popen:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join((str(ROOT), str(HELPERS.parent)))}
    return subprocess.Popen(
        [sys.executable, str(HELPERS), story, str(path)], env=environment, cwd=path.parent,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


def finish(process: subprocess.Popen) -> str:
    """Everything that the process said; it must end well within the deadline."""
    try:
        out, err = process.communicate(timeout=DEADLINE)
    finally:
        process.kill()
    assert process.returncode == 0, err
    return out


def test_a_recorder_that_is_killed_leaves_what_it_flushed(tmp_path):
    path = tmp_path / "killed.rrd"
    with start("flush-and-wait", path) as process:
        try:
            assert process.stdout.readline() == "flushed\n"
        finally:
            process.send_signal(signal.SIGKILL)
        assert process.wait(DEADLINE) == -signal.SIGKILL
    read = Read(path)
    rows = read.rows("/robots/body", "Points2D:positions")
    assert [tick for _, tick, _ in rows] == list(range(0, 201, 2))
    assert len(read.rows("/arena/plume", "Points2D:positions")) == 21
    assert len(read.rows("/robots/estimate", "Points2D:positions")) == 11
    assert read.blueprint_values("ViewBlueprint:space_origin")
    assert mend_after_quiet(path) == 0


@pytest.mark.skipif(sys.platform == "win32", reason="needs RLIMIT_FSIZE")
def test_a_full_disk_is_told_in_a_sentence_and_what_fits_can_be_read(tmp_path):
    path = tmp_path / "full.rrd"
    out = finish(start("disk-full", path))
    assert out.count("is the disk full?") == 1
    assert str(path) in out
    mend_after_quiet(path)
    assert "/robots/body" in Read(path).entities()


def test_a_viewer_that_never_answers_holds_nobody_up(tmp_path):
    path = tmp_path / "stuck.rrd"
    out = finish(start("stuck-viewer", path))
    assert out.count("the viewer") == 1
    assert len(Read(path).rows("/robots/body", "Points2D:positions")) == 201


def mend_after_quiet(path: Path) -> int:
    """Mend `path` as if its last write was long ago."""
    then = time.time() - 10.0 * QUIET
    os.utime(path, (then, then))
    return mend(path)


def test_half_a_message_at_the_end_is_cut_off_and_the_rest_stays(tmp_path):
    path = tmp_path / "torn.rrd"
    whole = record(path, messages(4.0), flush_every=60)
    data = path.read_bytes()
    rows = len(whole.rows("/plots/speed", "Scalars:scalars"))
    kept = []
    for share in (0.55, 0.7, 0.8, 0.9, 0.999):
        path.write_bytes(data[: round(share * len(data))])
        mend_after_quiet(path)
        assert data.startswith(path.read_bytes())
        assert mend_after_quiet(path) == 0
        kept.append(len(Read(path).rows("/plots/speed", "Scalars:scalars")))
    assert kept == sorted(kept)
    assert kept[-1] == rows


def test_a_recording_that_is_whole_stays_as_it_is(tmp_path):
    path = tmp_path / "whole.rrd"
    record(path, messages(1.0))
    before = path.read_bytes()
    assert mend_after_quiet(path) == 0
    assert path.read_bytes() == before
    assert whole_length(path) == len(before)


def test_a_file_that_is_still_being_written_is_left_alone(tmp_path):
    path = tmp_path / "busy.rrd"
    record(path, messages(1.0))
    path.write_bytes(path.read_bytes()[:-100])
    assert mend(path) == 0


def test_a_file_of_another_kind_is_left_alone(tmp_path):
    path = tmp_path / "other.rrd"
    path.write_bytes(b"not a recording, and longer than its header")
    assert mend_after_quiet(path) == 0
    assert whole_length(path) is None


def test_rerun_is_not_loaded_before_a_recording_is_made():
    program = "import sys, deploy.recorder; print(sorted({'rerun', 'pyarrow', 'numpy'} & sys.modules.keys()))"
    out = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"
