"""`odourswarm topology`: what a person and what a program read."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner, Result

from deploy.cli.graph_picture import MOST_DRAWN, draw
from deploy.cli.topology import topology
from protocol.scenario import Scenario
from protocol.topology.graph import make_graph
from protocol.topology.named import TOPOLOGIES, build

app = typer.Typer()
app.command()(topology)


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, list(arguments))


def test_json_is_one_object_and_nothing_else() -> None:
    result = run("fig-5.3", "--beta", "0.5", "--gamma", "0.9", "--json")
    assert (result.exit_code, result.stderr) == (0, "")
    facts = json.loads(result.stdout)
    assert facts["robots"] == 3
    assert facts["links"] == [[0, 1], [1, 2]]
    assert facts["edges"] == [[0, 1, 1.0], [1, 0, 1.0], [1, 2, 1.0], [2, 1, 1.0]]
    assert facts["eigenvalues"] == pytest.approx([0, 1, 3])
    assert facts["lambda_2"] == pytest.approx(1)
    assert (facts["connected"], facts["spanning_tree"], facts["directed"]) == (True, True, False)
    condition = facts["condition_5_2"]
    assert condition["smallest_gamma"] == pytest.approx(0.816, abs=1e-3)
    assert condition["holds"] is True


def test_the_gains_are_those_of_the_scenario_unless_given() -> None:
    condition = json.loads(run("ring", "--json").stdout)["condition_5_2"]
    assert (condition["beta"], condition["gamma"]) == (Scenario().dcs.beta, Scenario().dcs.gamma)
    assert json.loads(run("ring", "--gamma", "0.1", "--json").stdout)["condition_5_2"]["holds"] is False


@pytest.mark.parametrize("name", TOPOLOGIES)
def test_a_person_reads_picture_eigenvalues_and_verdict(name: str) -> None:
    result = run(name)
    assert result.exit_code == 0
    for words in (name, "eigenvalues of L", "λ₂", "connected", "yes", "condition (5.2)", "holds"):
        assert words in result.stdout


def test_a_verdict_that_is_bad_says_which_gain_would_do() -> None:
    words = " ".join(run("line", "--robots", "4", "--beta", "0.5", "--gamma", "0.9").stdout.split())
    assert "fails: γ = 0.9, β = 0.5; choose γ greater than 1.067" in words
    assert json.loads(run("line", "-n", "4", "--gamma", "1.067", "--json").stdout)["condition_5_2"]["holds"] is True


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["rign"], 'there is no topology "rign"; did you mean "ring"?'),
        (["nowhere.csv"], "nowhere.csv: there is no such file; give the path of a graph file."),
        (["ring", "--robots", "0"], "--robots is 0; it must be a whole number from 1 to 1000."),
        (["ring", "--beta", "nan"], "--beta: dcs.beta is nan; it must be a number > 0."),
        (
            ["fig-5.3", "-n", "5"],
            '--robots: topology "fig-5.3" has 3 robots and robots is 5; leave robots out, or make it 3.',
        ),
        (["ring", "--png", "no/such/dir/g.png"], "--png is no/such/dir/g.png; it must be a file that can be written"),
    ],
)
@pytest.mark.parametrize("json_flag", [[], ["--json"]])
def test_what_cannot_be_done_is_one_sentence_on_stderr(
    arguments: list[str], sentence: str, json_flag: list[str]
) -> None:
    result = run(*arguments, *json_flag)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(sentence)
    assert result.stderr.count("\n") == 1


def test_a_png_is_written_and_json_stays_clean(tmp_path: Path) -> None:
    file = tmp_path / "graph.png"
    result = run("star", "--json", "--png", str(file))
    assert json.loads(result.stdout)["robots"] == 5
    assert file.read_bytes().startswith(b"\x89PNG")


def test_without_a_name_the_topologies_are_listed() -> None:
    assert [line.split()[0] for line in run().stdout.splitlines()] == list(TOPOLOGIES)
    assert list(json.loads(run("--json").stdout)["topologies"]) == list(TOPOLOGIES)


@pytest.mark.parametrize("name", ["all", "ring", "line", "star"])
@pytest.mark.parametrize("robots", [1, 2, 5, MOST_DRAWN])
@pytest.mark.parametrize("fine", [True, False])
def test_a_picture_shows_every_robot_once(name: str, robots: int, fine: bool) -> None:
    picture = draw(build(name, robots), fine=fine)
    assert picture is not None
    numbers = "".join(c if c.isdecimal() else " " for c in picture.plain).split()
    assert sorted(map(int, numbers)) == list(range(robots))
    assert all(len(line) <= 84 for line in picture.plain.splitlines())
    assert fine or picture.plain.isascii()


def test_an_arrowhead_stands_only_where_one_is_not_heard_back() -> None:
    def arrows(*edges: tuple[int, int]) -> list[str]:
        picture = draw(make_graph(3, edges))
        assert picture is not None
        return [character for character in picture.plain if character in "→↗↑↖←↙↓↘"]

    assert arrows((0, 1), (1, 0)) == []
    assert arrows((0, 1), (1, 2), (2, 1)) == ["←"]  # 1 speaks to 0, which is drawn to its left
    assert arrows((1, 0), (1, 2), (2, 1)) == ["→"]


def test_a_matrix_marks_who_listens_to_whom() -> None:
    n = MOST_DRAWN + 1
    picture = draw(make_graph(n, [(2, 5)]))
    assert picture is not None
    rows = [line.split()[1:] for line in picture.plain.splitlines()[1:]]
    marks = [(i, j) for i, row in enumerate(rows) for j, cell in enumerate(row) if cell == "#"]
    assert marks == [(2, 5)]
    assert draw(build("ring", 1000)) is None
