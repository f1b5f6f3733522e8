"""From a file and flags to a checked scenario.

The layers, each over the one before:

    1. the defaults of the tables           (the preset "corrected")
    2. the preset's values                  (the preset's name may stand in any later layer)
    3. the scenario file
    4. the flags and --set, in their order  (the last one wins)

A `case` of Table 4.6 belongs to the layer that names it last and lies below that layer's own values. So `--case 3`
beats `wind.speed` of the file, `--wind 2` beats `--case 3`, and `source.x` of a file beats `case` of the same file.
A `graph` belongs to its `topology`: a later layer that names a topology drops the graph of an earlier one. The value of
`topology` is a name or a schedule, [[topology]]; either replaces the other.

Rules: every value of every layer is checked, also one that a later layer replaces; every refusal is one sentence.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path

import msgspec

from protocol.errors import ScenarioError
from protocol.scenario.check import check
from protocol.scenario.near import near
from protocol.scenario.presets import PRESETS, case_values
from protocol.scenario.resolve import resolve
from protocol.scenario.scenario import Scenario
from protocol.scenario.schema import one_of, show
from protocol.scenario.settings import Setting, named, parse_setting, read_settings
from protocol.scenario.stage import label
from protocol.scenario.toml_file import read_toml

__all__ = ["Override", "from_layers", "load_scenario", "parse_setting"]

_NO_FOLDERS: Mapping[str, Path] = {}

Override = tuple[str, object, str]  # (dotted name, value, where it was given: "--set wind.gain", "--robots")


def load_scenario(
    file: Path | None, *, overrides: Sequence[Override] = (), algorithms: Collection[str] = ()
) -> Scenario:
    """The complete scenario, graph included, of a file (or none) and flags.

    Args:
        file: a TOML file; None for the defaults.
        overrides: flags, in the order in which they were given.
        algorithms: the names that `algorithm` may have; empty: not checked here.
    Raises: ScenarioError with one sentence: which value, where, what is allowed.
    """
    layers = [tuple(read_settings((), read_toml(file), str(file)))] if file is not None else []
    layers.append(tuple(s for path, value, origin in overrides for s in _read_flag(path, value, origin)))
    folders = {str(file): file.parent} if file is not None else {}
    return from_layers(layers, algorithms=algorithms, folders=folders)


def from_layers(
    layers: Sequence[Sequence[Setting]],
    *,
    algorithms: Collection[str] = (),
    folders: Mapping[str, Path] = _NO_FOLDERS,
) -> Scenario:
    """The complete scenario of `layers`, each over the one before.

    Args:
        algorithms: as in `load_scenario`.
        folders: where the path of a graph file starts from, by the origin of `topology`; elsewhere: the working directory.
    Raises: ScenarioError.
    """
    settings = merge(layers)
    scenario = build(settings.values())
    origins = {path: setting.origin for path, setting in settings.items()}
    if algorithms and scenario.algorithm not in algorithms:
        raise ScenarioError(_no_algorithm(scenario.algorithm, origins.get("algorithm", ""), sorted(algorithms)))
    if "graph" not in settings:
        base_dir = folders.get(origins.get("topology", ""), Path())
        scenario = resolve(scenario, base_dir, robots_given="robots" in settings, origins=origins)
    return check(scenario, origins)


def merge(layers: Sequence[Sequence[Setting]]) -> dict[str, Setting]:
    """The setting that counts for every value that any layer gives, presets and cases included."""
    (_, preset), (case_layer, case) = _last("preset", layers), _last("case", layers)
    merged: dict[str, Setting] = {}
    if preset is not None:
        _lay(merged, PRESETS[str(preset.value)], f'preset "{preset.value}" ({preset.origin})')
    for n, layer in enumerate(layers):
        if case is not None and case.value and n == case_layer:
            _lay(merged, case_values(int(str(case.value))), f"case {case.value} ({case.origin})")
        own = {setting.path: setting for setting in layer}
        if "topology" in own:
            merged.pop("graph", None)
        merged |= own
    return merged


def build(settings: Iterable[Setting]) -> Scenario:
    """A scenario of the defaults and `settings`, converted strictly but not yet resolved or checked across fields."""
    nested: dict[str, object] = {}
    for setting in settings:
        table, _, key = setting.path.rpartition(".")
        inner = nested.setdefault(table, {}) if table else nested
        assert isinstance(inner, dict)
        inner[key] = setting.value
    if isinstance(stages := nested.get("topology"), tuple):
        nested |= {"topology": label(stages), "schedule": stages}
    return msgspec.convert(nested, Scenario)


def _read_flag(path: str, value: object, origin: str) -> Iterable[Setting]:
    return read_settings(tuple(path.split(".")), value, origin)


def _lay(merged: dict[str, Setting], values: Mapping[str, object], origin: str) -> None:
    merged |= {path: Setting(path, value, origin) for path, value in values.items()}


def _last(path: str, layers: Sequence[Sequence[Setting]]) -> tuple[int, Setting | None]:
    """The last setting of `path` and the layer that it stands in."""
    found = [(n, setting) for n, layer in enumerate(layers) for setting in layer if setting.path == path]
    return found[-1] if found else (-1, None)


def _no_algorithm(name: str, origin: str, known: list[str]) -> str:
    place = named(origin, "algorithm") if origin else "algorithm"
    return f"{place} is {show(name)}; it must be {one_of(known)}{near(name, known) or '.'}"
