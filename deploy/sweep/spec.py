"""A sweep's file: base values, a grid of lists, linked sets of values, seeds.

Rules: everything is read and checked before anything runs; every refusal is one sentence that names the file and the key.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from protocol.errors import ScenarioError
from protocol.scenario.near import near
from protocol.scenario.schema import show, tables, value_types
from protocol.scenario.settings import Setting, named, read_settings
from protocol.scenario.toml_file import read_toml

OWN = ("title", "seeds", "grid", "cells")  # what a scenario file does not have
MOST_SEEDS = 100_000
LAMBDA_2 = "lambda_2"  # a place on an axis that is worked out from the cell's graph
PLOT = 'plot = {"states lost, %" = 30}'
SEEDS = "seeds = {first = 1000, count = 50}"


@dataclass(frozen=True, slots=True)
class Cell:
    """A set of values that belong together."""

    label: str | None
    settings: tuple[Setting, ...]
    plot: tuple[tuple[str, float | str], ...] = ()  # where it stands in a picture: an axis' name, a number or LAMBDA_2


@dataclass(frozen=True, slots=True)
class Spec:
    """A sweep's file, every value of it allowed by its type."""

    file: Path
    title: str
    base: tuple[Setting, ...]
    grid: tuple[tuple[Setting, ...], ...]  # per value of the scenario its alternatives
    cells: tuple[Cell, ...]  # at least one
    first_seed: int
    seeds: int

    @property
    def name(self) -> str:
        """The file's name without its ending."""
        return self.file.stem


def read_spec(file: Path) -> Spec:
    """The sweep that `file` describes.

    Raises: ScenarioError.
    """
    tree = read_toml(file, "a sweep's file")
    first, count = _seeds(tree.get("seeds"), str(file))
    grid = tuple(_grid(tree.get("grid", {}), f"{file} [grid]"))
    cells = tuple(_cells(tree.get("cells", []), str(file)))
    _refuse_doubles(grid, cells, file)
    return Spec(
        file=file,
        title=_text(tree.get("title", ""), f"{file}: title"),
        base=_base({key: value for key, value in tree.items() if key not in OWN}, str(file)),
        grid=grid,
        cells=cells or (Cell(None, ()),),
        first_seed=first,
        seeds=count,
    )


def _base(tree: Mapping[str, object], origin: str) -> tuple[Setting, ...]:
    for key in tree:
        if key not in value_types() and key not in tables() and (hint := near(key, OWN)):
            raise ScenarioError(f"{origin}: there is no value or table {show(key)}{hint}")
    return _settings(tree, origin)


def _settings(tree: Mapping[str, object], origin: str) -> tuple[Setting, ...]:
    """The settings of a table as a scenario file has them."""
    settings = tuple(read_settings((), tree, origin))
    for setting in settings:
        _refuse_seed(setting.path, origin)
    return settings


def _grid(tree: object, origin: str) -> Iterator[tuple[Setting, ...]]:
    if not isinstance(tree, Mapping):
        raise ScenarioError(f'{origin} is {show(tree)}; it must be a table, for example algorithm = ["cfpso", "dcs"].')
    for name, values in _lists((), tree, origin):
        path = ".".join(name)
        _refuse_seed(path, origin)
        if not isinstance(values, list) or not values:
            sentence = f"{named(origin, path)} is {show(values)}; it must be a list with at least one value."
            raise ScenarioError(sentence)
        settings = tuple(setting for value in values for setting in read_settings(name, value, origin))
        for n, setting in enumerate(settings):
            if any(setting.value == other.value for other in settings[:n]):
                raise ScenarioError(f"{named(origin, path)} has {show(setting.value)} twice; leave one out.")
        yield settings


def _lists(name: tuple[str, ...], tree: Mapping[str, object], origin: str) -> Iterator[tuple[tuple[str, ...], object]]:
    """Every value of the grid with its name; `wind.gain` may be written as `"wind.gain"`, too."""
    for key, value in tree.items():
        inner = (*name, *key.split("."))
        path = ".".join(inner)
        if isinstance(value, Mapping) and path in tables():
            yield from _lists(inner, value, origin)
        elif path in value_types():
            yield inner, value
        else:
            # A name that is not known: this says what there is.
            list(read_settings(inner, value, origin))


def _cells(entries: object, file: str) -> Iterator[Cell]:
    if not isinstance(entries, list) or not all(isinstance(entry, Mapping) for entry in entries):
        raise ScenarioError(f"{file}: cells is {show(entries)}; it must be a list of tables, each under [[cells]].")
    for n, entry in enumerate(entries, 1):
        label = _text(entry["label"], f"{file} [[cells]] {n}: label") if "label" in entry else None
        origin = f"{file} [[cells]] {n}"
        settings = _settings({key: value for key, value in entry.items() if key not in ("label", "plot")}, origin)
        if "plot" in entry and label is None:
            raise ScenarioError(f"{origin}: plot is given and label is missing; a cell of a picture has a name of its own.")
        yield Cell(label, settings, tuple(_places(entry.get("plot", {}), f"{origin}: plot")))


def _places(value: object, name: str) -> Iterator[tuple[str, float | str]]:
    if not isinstance(value, Mapping):
        raise ScenarioError(f"{name} is {show(value)}; it must be a table, for example {PLOT}.")
    for axis, place in value.items():
        number = isinstance(place, int | float) and not isinstance(place, bool) and isfinite(place)
        if not number and place != LAMBDA_2:
            raise ScenarioError(f'{name}: {show(axis)} is {show(place)}; it must be a number, or "{LAMBDA_2}".')
        yield axis, place


def _seeds(value: object, file: str) -> tuple[int, int]:
    if not isinstance(value, Mapping):
        given = "missing" if value is None else show(value)
        raise ScenarioError(f"{file}: seeds is {given}; write {SEEDS}.")
    for key in value:
        if key not in ("first", "count"):
            raise ScenarioError(f"{file}: there is no value {show(key)} in seeds; write {SEEDS}.")
    first = _whole(value.get("first"), f"{file}: seeds.first", 0, 2**62)
    return first, _whole(value.get("count"), f"{file}: seeds.count", 1, MOST_SEEDS)


def _whole(value: object, name: str, low: int, high: int) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or not low <= value <= high:
        given = "missing" if value is None else show(value)
        raise ScenarioError(f"{name} is {given}; it must be a whole number from {low} to {high}.")
    return value


def _text(value: object, name: str) -> str:
    if not isinstance(value, str):
        raise ScenarioError(f"{name} is {show(value)}; it must be text.")
    return value


def _refuse_seed(path: str, origin: str) -> None:
    if path == "seed":
        raise ScenarioError(f"{origin}: seed cannot be given here; write {SEEDS} at the top.")


def _refuse_doubles(grid: tuple[tuple[Setting, ...], ...], cells: tuple[Cell, ...], file: Path) -> None:
    """A value either is crossed with the others or belongs to a set; in both places nobody could say which counts."""
    crossed = {settings[0].path for settings in grid}
    for cell in cells:
        for setting in cell.settings:
            if setting.path in crossed:
                sentence = f"{named(setting.origin, setting.path)} is given, and {file} [grid] has it, too"
                raise ScenarioError(f"{sentence}; leave one out.")
