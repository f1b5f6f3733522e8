"""A sweep's file: what it may say, in which order its layers count, and every mistake as one sentence."""

from pathlib import Path

import pytest
from sweep_helpers import command, plan_of, short_spec, write_spec

from deploy.sweep import studies
from deploy.sweep.plan import make_plan
from protocol.errors import ScenarioError
from protocol.scenario import scenario_digest
from protocol.scenario.load import load_scenario

SEEDS = "seeds = {first = 0, count = 1}\n"

MISTAKES = {
    "": "seeds is missing; write seeds = {first = 1000, count = 50}.",
    "seeds = 3": "seeds is 3; write seeds = {first = 1000, count = 50}.",
    "seeds = {first = 3}": "seeds.count is missing; it must be a whole number from 1 to 100000.",
    "seeds = {first = -1, count = 1}": "seeds.first is -1; it must be a whole number from 0 to",
    "seeds = {first = true, count = 1}": "seeds.first is true; it must be a whole number",
    "seeds = {start = 1, count = 1}": 'there is no value "start" in seeds',
    SEEDS + "wind.gian = 1": 'there is no value "gian" in table "wind"; did you mean "gain"?',
    SEEDS + "max_time = -1": "spec.toml: max_time is -1; it must be a number > 0",
    SEEDS + 'algorithm = "cfspo"': 'spec.toml: algorithm is "cfspo"; it must be',
    SEEDS + "seed = 3": "seed cannot be given here; write seeds = ",
    SEEDS + "title = 3": "title is 3; it must be text.",
    SEEDS + "gird.case = [1]": 'there is no value or table "gird"; did you mean "grid"?',
    SEEDS + "grid = 3": "spec.toml [grid] is 3; it must be a table",
    SEEDS + "grid.case = 3": "spec.toml [grid]: case is 3; it must be a list with at least one value.",
    SEEDS + "grid.case = []": "spec.toml [grid]: case is []; it must be a list with at least one value.",
    SEEDS + "grid.case = [1, 12]": "spec.toml [grid]: case is 12; it must be a whole number from 0 to 9.",
    SEEDS + "grid.case = [1, 2, 1]": "spec.toml [grid]: case has 1 twice; leave one out.",
    SEEDS + "grid.seed = [1, 2]": "spec.toml [grid]: seed cannot be given here",
    SEEDS + 'grid."wind.gian" = [1]': 'spec.toml [grid]: there is no value "gian" in table "wind"; did you mean "gain"?',
    SEEDS + 'grid.algorithm = ["cfpso", "cfspo"]': 'spec.toml [grid]: algorithm is "cfspo"; it must be',
    SEEDS + "cells = 3": "cells is 3; it must be a list of tables",
    SEEDS + "[[cells]]\nrobots = 0": "spec.toml [[cells]] 1: robots is 0; it must be",
    SEEDS + "[[cells]]\nlabel = 3": "spec.toml [[cells]] 1: label is 3; it must be text.",
    SEEDS + "grid.case = [1]\n[[cells]]\ncase = 2": "spec.toml [[cells]] 1: case is given, and",
    SEEDS + "[[cells]]\nrobots = 5\n[[cells]]\nwind.gain = 0.15": "a run is there twice",
    SEEDS + 'topology = "fig-5.3"\ngrid.robots = [3, 5]': 'topology "fig-5.3" has 3 robots and robots is 5',
    SEEDS + "source.x = 101": "spec.toml: the source is at (101, 0); it must be inside the arena",
    "seeds = {first = 0, count = 60000}\ngrid.case = [1, 2]": "these are 120000 runs (2 cells, 60000 seeds each)",
    SEEDS + "grid = [": "this is not valid TOML",
}


@pytest.mark.parametrize("text", MISTAKES)
def test_mistake_is_one_sentence_that_names_the_file_and_the_key(tmp_path, text):
    with pytest.raises(ScenarioError) as caught:
        plan_of(write_spec(tmp_path, text))
    sentence = str(caught.value)
    assert MISTAKES[text] in sentence
    assert sentence.startswith(str(tmp_path / "spec.toml"))
    assert "\n" not in sentence


def test_mistake_in_the_last_cell_ends_the_command_before_anything_runs(tmp_path):
    file = short_spec(tmp_path, more='\n[[cells]]\n[[cells]]\nwind.speed = 99\n')
    ended = command(file, "--out", tmp_path / "r.parquet")
    assert ended.exit_code == 2
    assert ended.stdout == ""
    assert ended.stderr.strip().splitlines() == [
        f"{file} [[cells]] 2: wind.speed is 99; it must be a number > 0 and <= 20."
    ]
    assert list(tmp_path.iterdir()) == [file]


def test_runs_are_the_cells_crossed_with_the_grid_and_the_seeds(tmp_path):
    text = """
    seeds = {first = 3, count = 2}
    [grid]
    case = [1, 2]
    wind.gain = [0, 0.5]
    [[cells]]
    label = "PSO-10"
    algorithm = "dcs"
    dcs.beta = 0.5
    [[cells]]
    """
    plan = plan_of(write_spec(tmp_path, text))
    assert plan.cells == 8
    assert plan.varied == ("case", "wind.gain", "algorithm", "dcs.beta")
    assert [(j.label, j.values["case"], j.values["wind.gain"], j.scenario.seed) for j in plan.jobs[:5]] == [
        ("PSO-10", 1, 0.0, 3), ("PSO-10", 1, 0.0, 4), ("PSO-10", 1, 0.5, 3), ("PSO-10", 1, 0.5, 4), ("PSO-10", 2, 0.0, 3),
    ]  # fmt: skip
    assert [j.label for j in plan.jobs[8:]] == ["cfpso"] * 8
    assert {j.values["dcs.beta"] for j in plan.jobs[:8]} == {0.5}
    assert len({j.digest for j in plan.jobs}) == 16


def test_scenario_is_what_flags_over_a_file_would_give(tmp_path):
    base = "seeds = {first = 5, count = 1}\nwind.speed = 3.0\nmax_time = 40\n"
    plan = plan_of(write_spec(tmp_path, base + 'grid.case = [4]\ngrid.topology = ["star"]\n[[cells]]\nsource.x = 22.0\n'))
    file = write_spec(tmp_path, "wind.speed = 3.0\nmax_time = 40\n", "scenario")
    flags = [("source.x", 22.0, "--source"), ("case", 4, "--case"), ("topology", "star", "-t"), ("seed", 5, "--seed")]
    scenario = load_scenario(file, overrides=flags)
    assert plan.jobs[0].scenario == scenario
    assert plan.jobs[0].digest == scenario_digest(scenario)
    # The grid's case beats the base's wind, a value of the same layer beats the case.
    assert (scenario.wind.speed, scenario.source.x) == (1.5, 22.0)


def test_graph_file_is_looked_for_beside_the_spec(tmp_path):
    (tmp_path / "pair.toml").write_text("robots = 2\nedges = [[0, 1]]\n")
    for text in ('topology = "./pair.toml"', 'grid.topology = ["./pair.toml"]', '[[cells]]\ntopology = "./pair.toml"'):
        plan = plan_of(write_spec(tmp_path, SEEDS + text))
        assert plan.jobs[0].scenario.robots == 2


@pytest.mark.parametrize("name", studies.names())
def test_packaged_study_is_right(name):
    plan = make_plan(studies.find_spec(name))
    assert plan.spec.title
    assert len(plan.jobs) == plan.cells * plan.spec.seeds


def test_studies_are_found_by_name_and_listed():
    assert {"nine-cases", "group-sizes", "unseen-cases"} <= set(studies.names())
    with pytest.raises(ScenarioError, match=r'no study "nin-cases"; did you mean "nine-cases"\?'):
        studies.find_spec("nin-cases")
    with pytest.raises(ScenarioError, match="there is no such file"):
        studies.find_spec("nine-cases.toml")
    listed = command()
    assert listed.exit_code == 0
    assert "nine-cases" in listed.stdout
    assert Path(studies.FOLDER).parent.name == "deploy"
