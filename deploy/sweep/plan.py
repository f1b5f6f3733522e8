"""The runs of a sweep, each a complete scenario.

The layers, each over the one before, as flags over a file: the spec's base values; a set of [[cells]] with one choice of
the [grid] and the seed. Rules: every scenario is checked here, before anything runs; no two are the same.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import msgspec

from deploy.sweep.axes import places
from deploy.sweep.spec import Cell, Spec
from protocol.errors import ScenarioError
from protocol.scenario import Scenario, scenario_digest
from protocol.scenario.load import from_layers
from protocol.scenario.schema import get_value
from protocol.scenario.settings import Setting
from robot_agent.algorithms import ALGORITHMS, refuse_declaring

ALWAYS = ("algorithm", "topology", "robots", "case", "max_time")  # columns of every result, in the grid or not
MOST_RUNS = 100_000

Value = str | int | float | bool


@dataclass(frozen=True, slots=True)
class Job:
    """One run."""

    cell: int  # which cell of the plan
    label: str
    values: dict[str, Value]  # the columns that say which cell it is, by dotted name
    scenario: Scenario
    digest: str  # the run's name: of all that decides it
    plot: str | None = None  # where its cell stands in a picture, see `axes`; None: nowhere

    @property
    def words(self) -> str:
        """The run in words, for a sentence."""
        own = {"label": self.label} if self.label != self.scenario.algorithm else {}
        return ", ".join(f"{name} {value}" for name, value in {**own, **self.values, "seed": self.scenario.seed}.items())


@dataclass(frozen=True, slots=True)
class Plan:
    """All runs of a sweep, cell by cell, within a cell seed by seed."""

    spec: Spec
    varied: tuple[str, ...]  # values that the grid or the cells give, in the file's order
    jobs: tuple[Job, ...]
    cells: int


def make_plan(spec: Spec) -> Plan:
    """The runs of `spec`.

    Raises: ScenarioError when a scenario is not complete or two are the same.
    """
    in_cells = dict.fromkeys(setting.path for cell in spec.cells for setting in cell.settings)
    varied = (*(settings[0].path for settings in spec.grid), *in_cells)
    columns = tuple(dict.fromkeys((*varied, *ALWAYS)))
    jobs: list[Job] = []
    known: set[str] = set()
    choices = list(itertools.product(spec.cells, itertools.product(*spec.grid)))
    if (runs := len(choices) * spec.seeds) > MOST_RUNS:
        sentence = f"{spec.file}: these are {runs} runs ({len(choices)} cells, {spec.seeds} seeds each)"
        raise ScenarioError(f"{sentence}; at most {MOST_RUNS} are allowed in one sweep.")
    for n, (cell, choice) in enumerate(choices):
        for job in _jobs(spec, n, cell, choice, columns):
            if job.digest in known:
                raise ScenarioError(f"{spec.file}: a run is there twice ({job.words}); leave one of the [[cells]] out.")
            known.add(job.digest)
            jobs.append(job)
    return Plan(spec, varied, tuple(jobs), len(choices))


def _jobs(
    spec: Spec, n: int, cell: Cell, choice: tuple[Setting, ...], columns: tuple[str, ...]
) -> list[Job]:
    over = (*cell.settings, *choice)
    folders = {setting.origin: spec.file.parent for setting in (*spec.base, *over)}
    jobs = []
    plot = None
    for seed in range(spec.first_seed, spec.first_seed + spec.seeds):
        layers = (spec.base, (*over, Setting("seed", seed, f"{spec.file}: seeds")))
        # From the layers for each seed, not by replacing it: a scenario may come to depend on its seed.
        scenario = from_layers(layers, algorithms=ALGORITHMS, folders=folders)
        _refuse(spec, scenario)
        values = {path: _plain(get_value(scenario, path)) for path in columns}
        label = cell.label if cell.label is not None else scenario.algorithm
        if cell.plot and plot is None:  # the first seed's stands for the cell
            plot = places(cell.plot, scenario)
        jobs.append(Job(n, label, values, scenario, scenario_digest(scenario), plot))
    return jobs


def _refuse(spec: Spec, scenario: Scenario) -> None:
    try:
        refuse_declaring(scenario)
    except ScenarioError as error:
        raise ScenarioError(f"{spec.file}: {error}") from None


def _plain(value: object) -> Value:
    """A value as a cell of a table: lists become text."""
    return value if isinstance(value, Value) else msgspec.json.encode(value).decode()
