"""Faults as a person writes them: a list of tables, each with its kind.

Rules: every refusal is a ScenarioError of one sentence: which entry and value, where, what is allowed.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import NoneType
from typing import Any, get_args, get_type_hints

import msgspec
from msgspec import inspect

from protocol.errors import ScenarioError
from protocol.scenario.faults import KINDS, Fault
from protocol.scenario.near import near, near_or_all
from protocol.scenario.schema import one_of, show, words

EXAMPLE = '[[faults]] kind = "loss", probability = 0.3'


def read_faults(value: object, origin: str) -> tuple[Fault, ...]:
    """The faults in `value`, which was given at `origin`.

    Raises: ScenarioError.
    """
    if isinstance(value, Mapping):  # one by itself, as --set 'faults={kind="crash", ...}'
        value = [value]
    if not isinstance(value, list | tuple) or not all(isinstance(each, Mapping | Fault) for each in value):
        raise ScenarioError(f"{origin}: faults is {show(value)}; it must be a list of tables, for example {EXAMPLE}.")
    return tuple(
        each if isinstance(each, Fault) else _read(each, f"{origin}: [[faults]] {n}")
        for n, each in enumerate(value, 1)
    )


def _read(entry: Mapping[str, object], place: str) -> Fault:
    kind = entry.get("kind")
    if not isinstance(kind, str) or kind not in KINDS:
        given = "missing" if kind is None else show(kind)
        hint = near(kind, KINDS) if isinstance(kind, str) else ""
        raise ScenarioError(f"{place}: kind is {given}; it must be {one_of(list(KINDS))}{hint or '.'}")
    record, place = KINDS[kind], f"{place} ({kind})"
    types = get_type_hints(record, include_extras=True)
    known = record.__struct_fields__
    for name, value in entry.items():
        if name == "kind":
            continue
        if name not in known:
            raise ScenarioError(f"{place}: there is no value {show(name)}{near_or_all(name, known)}")
        try:
            msgspec.convert(value, types[name])
        except (msgspec.ValidationError, OverflowError, RecursionError):
            allowed = words(_described(types[name]), value)
            raise ScenarioError(f"{place}: {name} is {show(value)}; it must be {allowed}.") from None
    for field in msgspec.structs.fields(record):
        if field.required and field.name not in entry:
            allowed = words(_described(types[field.name]))
            raise ScenarioError(f"{place}: {field.name} is missing; it must be {allowed}.")
    return msgspec.convert(dict(entry), record)


def _described(kind: Any) -> inspect.Type:
    """The type of a value; of one that may be left out, the type that it has when it is there."""
    options = [each for each in get_args(kind) if each is not NoneType]
    optional = NoneType in get_args(kind)
    return inspect.type_info(options[0] if optional else kind)
