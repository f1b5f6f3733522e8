"""`odourswarm reproduce`: what a person and what a program get, and what is on the disk afterwards."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import typer
from matplotlib.figure import Figure
from typer.testing import CliRunner
from typer.testing import Result as Ended

from deploy.cli.reproduce import reproduce
from deploy.reproduce import registry
from deploy.reproduce.kinds import AGREES, DIFFERS, OURS, Options, Reproduction, Result, Row
from deploy.reproduce.write import write
from protocol.errors import ScenarioError, SwarmFailure

app = typer.Typer()
app.command()(reproduce)


def run(*arguments: str) -> Ended:
    return CliRunner().invoke(app, list(arguments))


def result(options: Options) -> Result:
    figure = Figure()
    figure.subplots().plot([0, 1], [0, 1])
    rows = [
        Row("height [m]", "1.0 [/sic]", "1.1", DIFFERS, "a misprint"),
        Row("width", "", f"{options.seed}", OURS),
        Row("depth", "2", "2", AGREES),
    ]
    numbers = {"array": np.arange(3), "float": np.float32(0.5), "whole": np.int64(7), "bus": options.bus}
    return Result(rows, {"": figure, "side": figure}, numbers)


def raising(error: BaseException) -> Callable[[Options], Result]:
    def make(options: Options) -> Result:
        raise error

    return make


EXAMPLE = Reproduction("fig-0.1", "An example", "Figure 0.1", result)


@pytest.fixture
def registered(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Put other reproductions in the place of all."""

    def put(*reproductions: Reproduction) -> None:
        monkeypatch.setattr(registry, "ALL", {each.name: each for each in reproductions})

    return put


def test_no_name_is_registered_twice_and_none_is_a_word_of_the_command() -> None:
    names = [each.name for family in registry.FAMILIES for each in family]
    assert len(set(names)) == len(names) == len(registry.ALL)
    assert "all" not in names
    assert all(name == name.lower() and "/" not in name and " " not in name for name in names)


def test_without_a_name_everything_is_listed() -> None:
    words = run().stdout
    for name in registry.ALL:
        assert name in words
    facts = json.loads(run("--json").stdout)
    assert [each["name"] for each in facts["reproductions"]] == list(registry.ALL)


def test_a_person_reads_every_row_with_its_verdict(registered: Callable[..., None], tmp_path: Path) -> None:
    registered(EXAMPLE)
    shown = run("fig-0.1", "--out", str(tmp_path), "--seed", "5")
    assert shown.exit_code == 0
    words = " ".join(shown.stdout.split())
    for part in ("An example (Figure 0.1)", "differs height [m]", "thesis 1.0 [/sic]", "we 1.1", "a misprint", "we 5"):
        assert part in words
    assert "ours width we 5" in words  # the thesis says nothing about it: no line for it
    written = sorted(path.name for path in tmp_path.iterdir())
    assert written == ["fig-0.1-side.png", "fig-0.1.json", "fig-0.1.md", "fig-0.1.png"]
    told = (tmp_path / "fig-0.1.md").read_text()
    assert "![fig-0.1](fig-0.1.png)" in told
    assert "| the thesis |" in told
    assert (tmp_path / "fig-0.1.png").read_bytes().startswith(b"\x89PNG")


def test_json_is_one_object_on_one_line_the_same_as_on_the_disk(registered: Callable[..., None], tmp_path: Path) -> None:
    registered(EXAMPLE)
    shown = run("fig-0.1", "--out", str(tmp_path), "--bus", "memory", "--json")
    assert (shown.exit_code, shown.stderr, shown.stdout.count("\n")) == (0, "", 1)
    facts = json.loads(shown.stdout)
    assert facts == json.loads((tmp_path / "fig-0.1.json").read_text())
    assert facts["numbers"] == {"array": [0, 1, 2], "float": 0.5, "whole": 7, "bus": "memory"}
    assert [row["verdict"] for row in facts["rows"]] == [DIFFERS, OURS, AGREES]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["fig-0.2"], 'there is no reproduction "fig-0.2"; `odourswarm reproduce` lists them. Did you mean "fig-0.1"?'),
        (["zzz"], 'there is no reproduction "zzz"; `odourswarm reproduce` lists them.\n'),
        (["fig-0.1", "--bus", "rest"], '--bus is "rest"; it must be zenoh or memory.'),
    ],
)
def test_what_cannot_be_done_is_one_sentence_on_stderr(
    registered: Callable[..., None], arguments: list[str], sentence: str
) -> None:
    registered(EXAMPLE)
    shown = run(*arguments)
    assert (shown.exit_code, shown.stdout) == (2, "")
    assert shown.stderr.startswith(sentence)
    assert shown.stderr.count("\n") == 1


def test_a_folder_that_cannot_be_written_is_refused_before_the_work(registered: Callable[..., None], tmp_path: Path) -> None:
    registered(Reproduction("fig-0.1", "An example", "Figure 0.1", raising(AssertionError("the work has begun"))))
    in_the_way = tmp_path / "file"
    in_the_way.write_text("")
    for out in (in_the_way, in_the_way / "below"):
        shown = run("fig-0.1", "--out", str(out))
        assert shown.exit_code == 2
        assert shown.stderr.startswith(f"--out is {out}; it must be a folder that can be written (")


def test_all_goes_on_past_what_cannot_be_made(registered: Callable[..., None], tmp_path: Path) -> None:
    registered(
        Reproduction("poor", "Without a library", "", raising(ScenarioError("a library is missing."))),
        Reproduction("dead", "Without a robot", "", raising(SwarmFailure("robot 1 is gone."))),
        EXAMPLE,
    )
    shown = run("all", "--out", str(tmp_path), "--json")
    assert shown.exit_code == 3
    assert shown.stderr.splitlines() == ["poor: a library is missing.", "dead: robot 1 is gone."]
    assert json.loads(shown.stdout)["name"] == "fig-0.1"


def test_ctrl_c_keeps_what_was_finished(registered: Callable[..., None], tmp_path: Path) -> None:
    registered(EXAMPLE, Reproduction("long", "Too long", "", raising(KeyboardInterrupt())))
    shown = run("all", "--out", str(tmp_path))
    assert shown.exit_code == 130
    assert "interrupted; what was finished is written." in shown.stderr
    assert (tmp_path / "fig-0.1.json").exists()


def test_a_picture_that_fails_leaves_no_part_of_a_file(tmp_path: Path) -> None:
    class Broken(Figure):
        def savefig(self, fname: object, **options: object) -> None:
            Path(str(fname)).write_bytes(b"half")
            raise OSError(28, "No space left on device")

    with pytest.raises(ScenarioError, match="No space left on device"):
        write(EXAMPLE, Result(figures={"": Broken()}), tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_what_cannot_stand_in_a_file_is_a_bug_that_shows_itself(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="object cannot stand in a JSON file"):
        write(EXAMPLE, Result(numbers={"thing": object()}), tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_figure_of_the_thesis_is_made_from_its_name(tmp_path: Path) -> None:
    facts = json.loads(run("fig-4.7", "--out", str(tmp_path), "--json").stdout)
    assert facts["numbers"]["left"] == pytest.approx(3.567e-3, rel=1e-3)
    assert (tmp_path / "fig-4.7.png").stat().st_size > 10_000
