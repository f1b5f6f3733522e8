"""What a scenario may say: the dotted name of every value, its type, and what is allowed, in words.

Rules: everything here is read off the tables (sections.py, laws, scenario.py), nothing is listed twice; a new value in a
table is at once known to files, flags and error sentences.
"""

from __future__ import annotations

import json
from functools import cache
from typing import Any, get_type_hints

import msgspec
from msgspec import inspect

from protocol.scenario.scenario import Scenario
from protocol.scenario.table import Table

GUARD = 1e9  # the bound of numbers that need none: not worth a person's attention unless it is crossed
LONGEST = 60  # characters of a value quoted in a sentence


@cache
def tables() -> dict[str, type[Table]]:
    """Every table by its name, in the order of the scenario."""
    hints = get_type_hints(Scenario)
    return {name: kind for name, kind in hints.items() if isinstance(kind, type) and issubclass(kind, Table)}


@cache
def value_types() -> dict[str, Any]:
    """Type of every value by its dotted name ("seed", "wind.gain"), bounds included."""
    types: dict[str, Any] = {}
    for name, kind in get_type_hints(Scenario, include_extras=True).items():
        if name in tables():
            inner = get_type_hints(tables()[name], include_extras=True)
            types.update({f"{name}.{key}": each for key, each in inner.items()})
        elif name != "schedule":  # it is given as `topology`
            types[name] = kind
    return types


def get_value(scenario: Scenario, path: str) -> object:
    """The value that `scenario` has under a dotted name."""
    item: object = scenario
    for part in path.split("."):
        item = getattr(item, part)
    return item


def convert(path: str, value: object) -> object:
    """`value` as the type of `path`; whole numbers do for numbers, nothing else is converted.

    Raises: msgspec.ValidationError when it is not allowed (NaN and infinities never are).
    """
    return msgspec.convert(value, value_types()[path])


def allowed(path: str, value: object) -> str:
    """What `path` may be, in words that fit after "it must be"; `value` is what was given instead."""
    return words(inspect.type_info(value_types()[path]), value)


def choices_of(path: str) -> list[str]:
    """The names among which `path` chooses; empty when it is not such a choice."""
    kind = inspect.type_info(value_types()[path])
    return [str(each) for each in kind.values] if isinstance(kind, inspect.LiteralType) else []


def words(kind: inspect.Type, value: object = None) -> str:
    """A type with its bounds, in words."""
    match kind:
        case inspect.BoolType():
            text = "true or false"
        case inspect.IntType() | inspect.FloatType():
            text = ("a whole number" if isinstance(kind, inspect.IntType) else "a number") + _bounds(kind, value)
        case inspect.StrType():
            text = "text"
        case inspect.LiteralType():
            text = one_of([str(each) for each in kind.values])
        case inspect.UnionType():  # of a kind and None, which is said by leaving it out
            text = next(words(each, value) for each in kind.types if not isinstance(each, inspect.NoneType))
        case inspect.TupleType():
            text = "a list [" + ", ".join(words(each) for each in kind.item_types) + "]"
        case inspect.VarTupleType():
            text = "a list, each entry " + words(kind.item_type)
        case _:
            raise TypeError(f"no words for {kind}")
    return text


def one_of(names: list[str]) -> str:
    """`"a", "b" or "c"`."""
    quoted = [f'"{name}"' for name in names]
    return " or ".join(filter(None, (", ".join(quoted[:-1]), quoted[-1])))


def _bounds(kind: inspect.IntType | inspect.FloatType, value: object) -> str:
    number = value if isinstance(value, int | float) else 0
    low = kind.ge if kind.ge is not None else kind.gt
    high = kind.le if kind.le is not None else kind.lt
    if low is not None and low <= -GUARD <= number:
        low = None
    if high is not None and high == GUARD and not number > high:
        high = None
    if low is not None and high is not None and kind.gt is None and kind.lt is None:
        return f" from {_number(low)} to {_number(high)}"
    above = f" {'>' if kind.gt is not None else '>='} {_number(low)}" if low is not None else ""
    below = f" {'<' if kind.lt is not None else '<='} {_number(high)}" if high is not None else ""
    return " and".join(filter(None, (above, below)))


def _number(bound: float) -> str:
    return str(bound) if isinstance(bound, int) else f"{bound:g}"


def show(value: object) -> str:
    """`value` as it would stand in a scenario file, short enough for a sentence, always on one line."""
    match value:
        case bool():
            text = "true" if value else "false"
        case int():
            text = str(value) if abs(value) < 10**LONGEST else "a number with very many digits"
        case str():
            text = json.dumps(value, ensure_ascii=False)
        case list() | tuple():
            text = "[" + ", ".join(show(each) for each in value) + "]"
        case dict():
            text = "a table"
        case _:
            text = str(value)
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."
