"""The picture of a study: where its cells stand, what its lines are, and what the command draws."""

import pytest
from sweep_helpers import Quiet, command, plan_of, rows_of, short_spec, write_spec

from deploy.sweep.axes import places_of
from deploy.sweep.execute import execute
from deploy.sweep.plan import make_plan
from deploy.sweep.plot import lines_of
from deploy.sweep.rows import MEASURED
from deploy.sweep.studies import find_spec
from protocol.errors import ScenarioError

SEEDS = "seeds = {first = 0, count = 1}\n"
CELLS = """
[[cells]]
label = "calm"
plot = {loss = 0, delay = 0}
[[cells]]
label = "rough"
plot.loss = 30.5
faults = [{kind = "loss", probability = 0.3}]
[[cells]]
label = "elsewhere"
wind.gain = 0.5
"""

MISTAKES = {
    'label = "a"\nplot = 3': 'plot is 3; it must be a table, for example plot = {"states lost, %" = 30}.',
    'label = "a"\nplot.loss = "much"': 'plot: "loss" is "much"; it must be a number, or "lambda_2".',
    'label = "a"\nplot.loss = true': 'plot: "loss" is true; it must be a number',
    'label = "a"\nplot.loss = nan': "it must be a number",
    "plot.loss = 3": "plot is given and label is missing",
}


@pytest.mark.parametrize("text", MISTAKES)
def test_mistake_about_the_picture_is_one_sentence(tmp_path, text):
    with pytest.raises(ScenarioError) as caught:
        plan_of(write_spec(tmp_path, f"{SEEDS}[[cells]]\n{text}\n"))
    assert MISTAKES[text] in str(caught.value)
    assert "[[cells]] 1: plot" in str(caught.value)


def row(seed, algorithm, label, plot, **measured):
    blank = dict.fromkeys(MEASURED)
    return {
        **blank, "label": label, "algorithm": algorithm, "plot": plot, "max_time": 600.0, "seed": seed, "found": True,
        "scenario_digest": f"{algorithm}{label}{seed}", "time": 100.0 + seed, **measured,
    }  # fmt: skip


def test_line_of_an_algorithm_goes_from_left_to_right_over_all_cells_of_its_axis():
    rows = [
        row(seed, algorithm, label, plot, disagreement=gap, estimate_error=[1.0, None, 3.0 + seed])
        for algorithm in ("cfpso", "dcs")
        for label, plot, gap in (("b", '{"loss":30}', 2.0), ("a", '{"loss":0,"delay":0}', None), ("c", None, 9.0))
        for seed in (0, 2)
    ]
    axes = lines_of(rows, ("algorithm", "faults"))
    assert list(axes) == ["loss", "delay"]
    assert list(axes["loss"]) == ["cfpso", "dcs"]
    for points in axes["loss"].values():
        assert [(point.at, point.label) for point in points] == [(0.0, "a"), (30.0, "b")]
    calm, lossy = (point.cell for point in axes["loss"]["dcs"])
    assert (calm.runs, calm.median, calm.disagreement) == (2, 101.0, None)
    assert (lossy.disagreement, lossy.disagreement_interval) == (2.0, (2.0, 2.0))
    assert lossy.estimate_error == (2.0 + 3.0) / 2


def test_cell_of_several_axes_stands_on_each_of_them_and_its_rows_remember(tmp_path):
    plan = plan_of(short_spec(tmp_path, seeds=1, more=CELLS))
    execute(plan, tmp_path / "r.parquet", 1, Quiet())
    rows = rows_of(tmp_path / "r.parquet")
    assert [places_of(each) for each in rows if each["algorithm"] == "dcs"] == [{"loss": 0, "delay": 0}, {"loss": 30.5}, {}]
    assert "plot" not in plan.varied


def test_command_draws_a_result_with_and_without_its_spec(tmp_path):
    spec, out = short_spec(tmp_path, seeds=1, more=CELLS), tmp_path / "r.parquet"
    first, second = tmp_path / "a.png", tmp_path / "b.png"
    ended = command(spec, "--out", out, "--jobs", 1, "--plot", first)
    assert ended.exit_code == 0, ended.stderr
    assert command(out, "--summary", "--plot", second).exit_code == 0
    for picture in (first, second):
        assert picture.read_bytes().startswith(b"\x89PNG")


def test_picture_that_cannot_be_drawn_is_refused_before_anything_runs(tmp_path):
    spec = short_spec(tmp_path)
    ended = command(spec, "--out", tmp_path / "r.parquet", "--plot", tmp_path / "a.png")
    assert (ended.exit_code, ended.stdout) == (2, "")
    assert "no cell says where it stands in a picture; write for example plot = " in ended.stderr
    ended = command(spec, "--out", tmp_path / "r.parquet", "--plot", tmp_path / "a.txt")
    assert ended.exit_code == 2
    assert "ends in .png, .svg or .pdf" in ended.stderr
    assert not (tmp_path / "r.parquet").exists()


def test_lambda_2_is_that_of_the_graph_where_the_robots_start():
    at = {job.label: places_of({"plot": job.plot}) for job in make_plan(find_spec("topologies")).jobs}
    values = {label: place["λ₂ of the graph"] for label, place in at.items()}
    # Complete graph: N; ring: 2 - 2 cos(2 pi / N); star: 1; line: 2 - 2 cos(pi / N); directed ring: 1 - cos(2 pi / N).
    assert values["all"] == pytest.approx(5.0)
    assert values["ring"] == pytest.approx(1.381966)
    assert values["star"] == pytest.approx(1.0)
    assert values["line"] == pytest.approx(0.381966)
    assert values["directed-ring"] == pytest.approx(0.690983)
    # Half of the time a line, half of the time nobody.
    assert values["line, nobody, every 10 s"] == pytest.approx(0.381966 / 2)


def test_faults_study_has_every_axis_of_the_laboratory_from_no_fault_on():
    plan = make_plan(find_spec("faults"))
    places = {}
    for job in plan.jobs:
        for axis, at in places_of({"plot": job.plot}).items():
            places.setdefault(axis, set()).add(at)
    assert places == {
        "states lost, %": {0, 15, 30, 45, 60}, "delay, s": {0, 0.1, 0.5, 1, 2}, "robots dead": {0, 1, 2, 3},
        "cut in two for, s": {0, 10, 20, 40, 80}, "liars, plain fusion": {0, 1}, "liars, resilient fusion": {0, 1},
    }  # fmt: skip
    assert {job.scenario.seed for job in plan.jobs} == set(range(4000, 4030))
    for job in plan.jobs:
        for fault in job.scenario.faults:
            if (loss := getattr(fault, "probability", None)) and "loss" in job.label:
                assert places_of({"plot": job.plot}) == {"states lost, %": 100 * loss}
