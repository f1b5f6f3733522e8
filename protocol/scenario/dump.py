"""A scenario as a file: the values that a person has to write down to repeat the run.

Rules: `load_scenario` of the text gives the same scenario, whatever the presets and cases; defaults are left out,
and so is a graph that its topology's name gives again.
"""

from __future__ import annotations

import json

from msgspec import structs

from protocol.scenario.faults import Fault
from protocol.scenario.presets import PRESETS, case_values
from protocol.scenario.scenario import Scenario
from protocol.scenario.schema import get_value, value_types

HEADER = "# odourswarm scenario: every value that is not the default\n"


def dump_toml(scenario: Scenario) -> str:
    """TOML text of `scenario`."""
    default = Scenario()
    implied = {**PRESETS[scenario.preset], **(case_values(scenario.case) if scenario.case else {})}
    lines = [HEADER]
    table = ""
    for path in _top_first():
        value = get_value(scenario, path)
        if path == "graph":
            wanted = _graph_is_needed(scenario)
        else:
            # A preset or a case says otherwise: then the default itself has to be written down.
            wanted = value != get_value(default, path) or value != implied.get(path, value)
        if not wanted:
            continue
        name, _, key = path.rpartition(".")
        if name != table:
            lines.append(f"\n[{name}]\n")
            table = name
        lines.append(f"{key} = {_toml(value)}\n")
    return "".join(lines)


def _top_first() -> list[str]:
    """All values, those of no table first, as TOML wants them; graph last among these, for it is long."""
    return sorted(value_types(), key=lambda path: (path.count("."), path == "graph"))


def _graph_is_needed(scenario: Scenario) -> bool:
    from protocol.topology.named import TOPOLOGIES, build

    if scenario.topology not in TOPOLOGIES:
        return True
    fixed = TOPOLOGIES[scenario.topology].robots
    same_size = fixed is None or fixed == scenario.robots
    return not same_size or build(scenario.topology, scenario.robots).edges != scenario.graph


def _inline(value: object) -> str:
    """A value in one line, as an inline table needs it."""
    return "[" + ", ".join(map(_inline, value)) + "]" if isinstance(value, tuple) else _toml(value)


def _toml(value: object) -> str:
    match value:
        case bool():
            return "true" if value else "false"
        case str():
            return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        case int() | float():
            return repr(value)
        case Fault():
            given = [(each.name, getattr(value, each.name), each.default) for each in structs.fields(value)]
            pairs = [("kind", value.__struct_config__.tag), *((name, v) for name, v, default in given if v != default)]
            return "{" + ", ".join(f"{name} = {_inline(v)}" for name, v in pairs) + "}"
        case tuple() if value and isinstance(value[0], tuple | Fault):
            return "[\n" + "".join(f"    {_toml(each)},\n" for each in value) + "]"
        case tuple():
            return "[" + ", ".join(_toml(each) for each in value) + "]"
        case _:
            raise TypeError(f"no TOML form for {value!r}")
