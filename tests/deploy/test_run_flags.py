"""Flags of `odourswarm run` that contradict each other are refused with a sentence, before anything runs."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from deploy.cli.app import app


@pytest.mark.parametrize(
    ("flags", "sentence"),
    [
        (["--restart", "always"], '--restart is "always", and --bus is "memory": one process has no others to start again'),
        (["--restart", "crashed"], '--restart is "crashed", and --bus is "memory"'),
        (["--checkpoint-every", "5"], '--checkpoint-every is 5, and --bus is "memory"'),
    ],
)
def test_what_only_processes_can_do_is_refused_in_memory(flags: list[str], sentence: str) -> None:
    result = CliRunner().invoke(app, ["run", "--bus", "memory", *flags])
    assert result.exit_code == 2
    assert sentence in result.output
    assert "--bus zenoh" in result.output


def test_a_refused_run_makes_no_folder_for_its_checkpoints(tmp_path: Path) -> None:
    folder = tmp_path / "kept"
    result = CliRunner().invoke(app, ["run", "--bus", "memory", "--checkpoint-every", "5", "--checkpoint", str(folder)])
    assert result.exit_code == 2
    assert not folder.exists()


def test_asking_for_no_restarts_is_no_contradiction() -> None:
    quick = ["--max-time", "0.1", "--set", "plume.warm_up=0"]
    result = CliRunner().invoke(app, ["run", "--bus", "memory", "--restart", "never", "--checkpoint-every", "0", *quick])
    assert result.exit_code == 0
