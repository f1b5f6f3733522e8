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
    for words in (name, "eigenvalues of L", "λ₂", "connected", "yes", "condition (5.2)"):
        assert words in result.stdout
    assert ("must be undirected" if name == "directed-ring" else "holds") in result.stdout


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


SWITCHING = '[[topology]]\nat = 0\nname = "line"\n[[topology]]\nat = 10\nname = "star"\n[graph_options]\nperiod = 20\n'


def test_a_schedule_is_told_stage_by_stage_and_together(tmp_path: Path) -> None:
    file = tmp_path / "switching.toml"
    file.write_text(SWITCHING)
    facts = json.loads(run(str(file), "--json").stdout)
    assert [stage["at"] for stage in facts["stages"]] == [0, 10]
    assert [stage["lambda_2"] for stage in facts["stages"]] == pytest.approx([0.381966, 1])
    assert [stage["condition_5_2"]["holds"] for stage in facts["stages"]] == [True, True]
    assert facts["jointly_connected"] is True
    assert [(each["t"], each["connected"]) for each in facts["over_time"]] == [(t, True) for t in (0, 10, 20, 30, 40)]
    words = run(str(file), "--robots", "4").stdout
    for part in ("line > star@10", "again every 20 s", "4 robots", "jointly connected: yes", "connected all the time"):
        assert part in words


def test_stages_that_are_apart_one_by_one_can_be_connected_together(tmp_path: Path) -> None:
    halves = ([[0, 1, 1.0], [1, 0, 1.0]], [[1, 2, 1.0], [2, 1, 1.0]])
    tables = (f'{{at = {4 * n}, name = "half-{n}", edges = {edges}}}' for n, edges in enumerate(halves))
    file = tmp_path / "halves.toml"
    file.write_text(f"robots = 3\ntopology = [{', '.join(tables)}]\ngraph_options.period = 10\n")
    facts = json.loads(run(str(file), "--json").stdout)
    assert [stage["connected"] for stage in facts["stages"]] == [False, False]
    assert facts["jointly_connected"] is True
    # The mean graph is the line with weights 0.4 and 0.6; its nonzero eigenvalues solve s^2 - 2 s + 3 * 0.24 = 0.
    assert facts["mean_lambda_2"] == pytest.approx(1 - 0.28**0.5)
    words = run(str(file)).stdout
    assert "not connected 100 % of the time, at most 20 s on end" in words


def test_a_range_is_told_for_the_start_or_along_a_run() -> None:
    flags = ["range-limited", "--set", "graph_options.range=4", "--set", "max_time=3", "--set", "plume.warm_up=1", "--json"]
    at_start = json.loads(run(*flags).stdout)
    assert at_start["over_time_of"] == "schedule"
    assert at_start["stages"][0]["links"] == [[0, 1], [1, 2], [2, 3], [3, 4]]  # the column's robots are 3 m apart
    along = json.loads(run(*flags, "--follow").stdout)
    assert along["over_time_of"] == "run"
    assert [each["t"] for each in along["over_time"]] == pytest.approx([1, 2, 3])


def test_only_a_graph_that_changes_can_be_followed() -> None:
    result = run("ring", "--follow")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == "--follow is for a graph that changes, and ring never does; leave it out.\n"


@pytest.mark.parametrize("name", ["range-limited", "switching.toml"])
def test_a_png_of_a_graph_that_changes_is_written(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("switching.toml").write_text(SWITCHING)
    assert run(name, "--png", "graph.png").exit_code == 0
    assert Path("graph.png").read_bytes().startswith(b"\x89PNG")


def test_what_a_generated_graph_depends_on_can_be_set() -> None:
    links = [len(json.loads(run("random", "-n", "9", "--set", f"graph_options.mean_degree={d}", "--json").stdout)["links"])
             for d in (0, 4, 99)]  # fmt: skip
    assert links == [8, 18, 36]


def test_a_bad_schedule_is_one_sentence_on_stderr(tmp_path: Path) -> None:
    file = tmp_path / "bad.toml"
    file.write_text(SWITCHING.replace("at = 10", "at = 0"))
    result = run(str(file))
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == f"{file}: topology, entry 2: at is 0; it must be greater than 0, the entry before.\n"
