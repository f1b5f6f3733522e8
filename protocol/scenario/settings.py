"""One value from one place: settings are read from tables and flags, checked one by one, and remember their place.

Rules: every refusal is a ScenarioError of one sentence: which value, where, what is allowed, what was probably meant.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import msgspec

from protocol.errors import ScenarioError
from protocol.scenario.faults.read import read_faults
from protocol.scenario.near import near, near_or_all
from protocol.scenario.schema import allowed, choices_of, convert, show, tables, value_types


@dataclass(frozen=True, slots=True)
class Setting:
    """A value of the scenario and where it was given: a file name, a flag, a case, a preset."""

    path: str  # dotted name
    value: object
    origin: str


def parse_setting(text: str) -> tuple[str, object]:
    """Name and value of a `--set` argument; the value is TOML, and what is not TOML is text.

    "wind.gain=1.0" -> ("wind.gain", 1.0);  "algorithm=dcs" -> ("algorithm", "dcs")
    Raises: ScenarioError when there is no name or no "=".
    """
    path, equals, value = text.partition("=")
    path = path.strip()
    if not equals or not path:
        raise ScenarioError(f"--set {show(text)}: write NAME=VALUE, for example --set wind.gain=1.0.")
    try:
        parsed = tomllib.loads(f"value = {value}")
    except (ValueError, RecursionError):
        return path, value.strip()
    return path, parsed["value"] if parsed.keys() == {"value"} else value.strip()


def read_settings(name: tuple[str, ...], value: object, origin: str) -> Iterator[Setting]:
    """The settings in `value`, which was given under `name` at `origin`: one, or those of a table, or of a whole file.

    Raises: ScenarioError for an unknown name or a value that is not allowed.
    """
    path = ".".join(name)
    if path == "faults":
        yield Setting(path, read_faults(value, origin), origin)
    elif path == "topology" and isinstance(value, list | Mapping):
        from protocol.scenario.schedule import read_schedule

        yield Setting(path, read_schedule(value, origin), origin)
    elif path in value_types():
        try:
            yield Setting(path, convert(path, value), origin)
        except (msgspec.ValidationError, OverflowError, RecursionError):
            sentence = f"{named(origin, path)} is {show(value)}; it must be {allowed(path, value)}"
            raise ScenarioError(sentence + _near_choice(path, value)) from None
    elif isinstance(value, Mapping) and (not name or path in tables()):
        for key, inner in value.items():
            yield from read_settings((*name, str(key)), inner, origin)
    elif path in tables():
        keys = ", ".join(_keys(path))
        raise ScenarioError(f"{named(origin, path)} is {show(value)}; it must be a table with {keys}.")
    else:
        raise ScenarioError(f"{origin}: {_unknown(name, isinstance(value, Mapping))}")


def named(origin: str, path: str) -> str:
    """The value and where it stands: "scenario.toml: wind.gain", but "--robots" where the flag is the value's own."""
    own = (f"--set {path}", "--" + path.replace("_", "-"))
    return origin if origin in own else f"{origin}: {path}"


def placed(sentence: str, origins: Mapping[str, str], *paths: str) -> str:
    """`sentence`, about the values `paths`, with the places where they were given in front."""
    places = where(origins, *paths)
    flag = places.removesuffix(": ")
    if sentence.startswith(f"{paths[0]} ") and named(flag, paths[0]) == flag:
        return flag + sentence.removeprefix(paths[0])
    return places + sentence


def where(origins: Mapping[str, str], *paths: str) -> str:
    """Where the values `paths` were given, to start a sentence with; nothing when all of them are defaults."""
    places = dict.fromkeys(origins[path] for path in paths if path in origins)
    return " and ".join(places) + ": " if places else ""


def _near_choice(path: str, value: object) -> str:
    choices = choices_of(path)
    return (near(value, choices) if choices and isinstance(value, str) else "") or "."


def _keys(table: str) -> list[str]:
    return list(tables()[table].__struct_fields__)


def _unknown(name: tuple[str, ...], is_table: bool) -> str:
    """Why there is nothing under `name`, with what was probably meant."""
    first, rest = name[0], ".".join(name[1:])
    if rest and first in tables():
        return f"there is no value {show(rest)} in table {show(first)}{near_or_all(rest, _keys(first))}"
    if rest or is_table:
        return f"there is no table {show(first)}{near_or_all(first, tables())}"
    top = [*(path for path in value_types() if "." not in path), *tables()]
    inside = [path for path in value_types() if path.endswith(f".{first}")]  # a value whose table was left out
    hint = f'; did you mean "{inside[0]}"?' if inside else near_or_all(first, top)
    return f"there is no value {show(first)}{hint}"
