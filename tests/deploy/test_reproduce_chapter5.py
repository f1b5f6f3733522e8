"""The examples and experiments of chapter 5: rates against theory, the scenario files, the swarm over both buses."""

import json
import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import deploy
from deploy.reproduce import registry
from deploy.reproduce.chapter5 import REPRODUCTIONS, robots, worked
from deploy.reproduce.chapter5.decay import below, furthest_pair, rate
from deploy.reproduce.chapter5.integrators import Sampling, integrate
from deploy.reproduce.kinds import AGREES, DIFFERS, Options
from deploy.reproduce.trajectory import record
from robot_agent.algorithms import ALGORITHMS
from robot_agent.control.consensus_laws import agreement

ODOURSWARM = [sys.executable, "-m", "deploy.cli"]
FILES = sorted((Path(deploy.__file__).parent / "scenarios").glob("fig-5.*.toml"))


def test_a_rate_is_the_slope_and_a_time_is_when_it_stays_below():
    t = np.linspace(0.0, 10.0, 101)
    assert rate(t, 3.0 * np.exp(-0.7 * t), 2.0, 9.0) == pytest.approx(0.7)
    assert below(t, np.exp(-t), np.exp(-5.05)) == pytest.approx(5.1)
    assert below(t, np.where(t < 8.0, 0.0, 1.0), 0.5) is None
    assert below(t, 0.0 * t, 0.5) == 0.0


@pytest.mark.parametrize("dt", [0.02, 0.01, 0.005])
def test_the_tail_of_consensus_falls_at_beta_over_gamma_as_the_step_shrinks(dt):
    """Not in finite time: y' = -(beta/gamma) y, and the step adds an error of its own order."""
    phi = partial(agreement, beta=0.5, gamma=0.9)
    course = integrate(phi, [(-9, 0), (0, 0), (9, 0)], [(20, 0), (4, 0), (-20, 0)], 40.0,
                       Sampling(0.6, worked.K, dt, keep=0.1, centred=True))  # fmt: skip
    slope = rate(course.t, furthest_pair(course.x), 20.0, 40.0)
    assert 0.5 / 0.9 < slope < 0.5 / 0.9 + 1.5 * dt


def test_the_worked_examples_agree_in_numbers_and_differ_in_what_they_claim(monkeypatch):
    monkeypatch.setattr(worked, "DT", 0.005)
    result = worked.consensus_example(Options("memory"))
    said = {row.quantity: row for row in result.rows}
    assert said["condition (5.2)"].verdict == AGREES
    assert said["rate of the tail of |x_i - x_j|"].verdict == DIFFERS
    assert result.numbers["rate"] == pytest.approx(0.5 / 0.9, abs=0.01)
    assert 1e-13 < result.numbers["error_at_55.32"] < 1e-11
    assert 1e-6 < result.numbers["explicit_floor"] < 1e-4
    assert result.figures.keys() == {""}


def test_the_parallel_example_settles_at_the_printed_time(monkeypatch):
    monkeypatch.setattr(worked, "DT", 0.005)
    result = worked.parallel_example(Options("memory"))
    assert 1e-10 < result.numbers["error_at_46.05"] < 1e-8
    for mu, theory in result.numbers["theory"].items():
        assert result.numbers["rates"][mu] == pytest.approx(theory, abs=0.01)


def test_every_reproduction_of_chapter_5_is_registered_with_a_name_of_its_own():
    names = [each.name for each in REPRODUCTIONS]
    assert len(set(names)) == len(names)
    assert all(registry.find(name) is each for name, each in zip(names, REPRODUCTIONS, strict=True))


def test_every_experiment_has_its_scenario_file_and_no_source():
    assert {file.stem for file in FILES} == {each.name for each in robots.ROBOTS}
    for file in FILES:
        s = robots.scenario_of(file.stem, seed=0)
        assert ALGORITHMS[s.algorithm].drill
        assert (s.plume.release_rate, s.timing.tick, s.robots) == (0.0, 0.01, 3)


def test_the_parallel_experiment_does_what_section_5_3_says_and_not_in_finite_time():
    result = robots.parallel_experiment("fig-5.19", Options("memory"))
    verdicts = {row.quantity: row.verdict for row in result.rows}
    assert verdicts["formation, x_i - h_i -> x_j - h_j"] == AGREES
    assert verdicts["linear velocity"] == verdicts["heading"] == AGREES
    assert verdicts["rate of its tail"] == DIFFERS
    assert result.figures.keys() == {"", "curves"}


def test_the_printed_circles_ask_more_than_the_robots_can_and_slower_ones_do_not(monkeypatch):
    short = dict(robots.CIRCLES)
    monkeypatch.setattr(robots, "CIRCLES", (("as printed", {}), ("slow", {**short["omega_0 = 0.05"], "max_time": 40.0})))
    result = robots.circular_experiment("fig-5.13", Options("memory"))
    verdicts = {row.quantity: row.verdict for row in result.rows}
    assert verdicts["as printed: radii in the last turn"] == DIFFERS
    assert verdicts["slow: settled, all within 0.05 m of their places"] == AGREES


def test_a_trajectory_starts_at_rest_at_the_start_and_misses_nothing_in_memory():
    s = robots.scenario_of("fig-5.8", seed=0, max_time=1.25)
    run = record(s, "memory", 0.5)
    assert run.t.tolist() == pytest.approx([0.0, 0.5, 1.0, 1.25])
    assert run.missed == 0
    assert run.robots[0, :, :2].tolist() == [list(point) for point in s.start.positions]
    assert not run.hand_velocities(s.body.hand)[0].any()
    way = np.linalg.norm(np.diff(run.hands(s.body.hand), axis=0), axis=2).sum(axis=0)
    assert (way <= np.array(run.outcome.distance_travelled) + 1e-9).all()


@pytest.mark.processes
@pytest.mark.parametrize("name", ["fig-5.8", "fig-5.23"])
def test_an_exercise_over_real_processes_is_the_one_in_memory(name):
    s = robots.scenario_of(name, seed=0, max_time=3.0)
    over_zenoh, in_memory = record(s, "zenoh", 0.5), record(s, "memory", 0.5)
    assert over_zenoh.outcome.digest == in_memory.outcome.digest
    assert over_zenoh.missed < len(in_memory.t)
    arrived = np.isin(in_memory.t, over_zenoh.t)
    assert arrived.sum() >= 2
    assert (over_zenoh.robots == in_memory.robots[arrived]).all()


def run_command(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [*ODOURSWARM, "run", "--bus", "memory", "--max-time", "1", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)


def test_a_run_with_gains_that_do_not_fit_warns_on_stderr_and_goes_on():
    ended = run_command("-a", "dcs", "-t", "line", "-n", "10", "--json", "--set", "plume.warm_up=0")
    assert ended.returncode == 0
    assert json.loads(ended.stdout)["ended"] == "time out"
    assert "warning: dcs on line, 10 robots: condition (5.2) fails" in ended.stderr
    assert "dcs.gamma > 2.61, and it is 2." in ended.stderr


def test_an_exercise_ends_at_its_time_with_status_0_and_no_warning():
    ended = run_command(str(FILES[0]), "--json")
    assert (ended.returncode, ended.stderr) == (0, "")
    outcome = json.loads(ended.stdout)
    assert (outcome["found"], outcome["time"], outcome["estimate_error"]) == (False, 1.0, [None, None, None])


def test_an_exercise_with_a_source_says_how_to_leave_it_out():
    ended = run_command("-a", "circular", "-n", "3", "--set", "plume.warm_up=0", "--json")
    assert ended.returncode == 0
    assert "--set plume.release_rate=0" in ended.stderr
