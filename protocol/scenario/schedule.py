"""A schedule as a person writes it: `[[topology]]` tables instead of one name.

    [[topology]]
    at = 0
    name = "line"

    [[topology]]
    at = 10.0
    name = "star"
    range = 40.0        # perhaps: only who is within so many metres

Rules: types are checked here, entry by entry; that the times fit together is checked with the whole scenario.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any, get_type_hints

import msgspec
from msgspec import inspect

from protocol.errors import ScenarioError
from protocol.scenario.near import near_or_all
from protocol.scenario.schema import show, words
from protocol.scenario.settings import named
from protocol.scenario.stage import Stage

MOST_STAGES = 1000
FORM = 'write [[topology]] tables, each with at = SECONDS and name = "TOPOLOGY"'


def read_schedule(value: object, origin: str) -> tuple[Stage, ...]:
    """The stages of a `topology` that is a list of tables.

    Raises: ScenarioError that names the entry and what is allowed.
    """
    place = named(origin, "topology")
    if not isinstance(value, list) or not 0 < len(value) <= MOST_STAGES:
        count = "a table" if isinstance(value, Mapping) else "an empty list" if not value else "too long a list"
        raise ScenarioError(f"{place} is {count}; {FORM}, 1 to {MOST_STAGES} of them, or topology = NAME.")
    return tuple(_stage(entry, f"{place}, entry {n}") for n, entry in enumerate(value, 1))


def _stage(entry: object, place: str) -> Stage:
    if not isinstance(entry, Mapping):
        raise ScenarioError(f"{place} is {show(entry)}; {FORM}.")
    for key, value in entry.items():
        if key not in _types():
            raise ScenarioError(f"{place}: there is no value {show(key)}{near_or_all(str(key), _types())}")
        try:
            msgspec.convert(value, _types()[key])
        except (msgspec.ValidationError, OverflowError, RecursionError):
            must = words(inspect.type_info(_types()[key]), value)
            raise ScenarioError(f"{place}: {key} is {show(value)}; it must be {must}.") from None
    for key in ("at", "name"):
        if key not in entry:
            raise ScenarioError(f"{place}: {key} is missing; {FORM}.")
    return msgspec.convert(entry, Stage)


@cache
def _types() -> dict[str, Any]:
    return get_type_hints(Stage, include_extras=True)
