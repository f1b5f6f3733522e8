"""A scenario as a file: the values that a person has to write down to repeat the run.

Rules: `load_scenario` of the text gives the same scenario, whatever the presets and cases; defaults are left out,
and so is a graph that its topology's name gives again.
"""

from __future__ import annotations

import json

from msgspec import structs

from protocol.errors import ScenarioError
from protocol.scenario.faults import Fault
from protocol.scenario.presets import PRESETS, case_values
from protocol.scenario.scenario import Scenario
from protocol.scenario.schema import get_value, value_types
from protocol.scenario.stage import Stage

HEADER = "# odourswarm scenario: every value that is not the default\n"


def dump_toml(scenario: Scenario) -> str:
    """TOML text of `scenario`."""
    default = Scenario()
    implied = {**PRESETS[scenario.preset], **(case_values(scenario.case) if scenario.case else {})}
    lines = [HEADER]
    table = ""
    named = _name_says_all(scenario)
    for path in _top_first():
        value = get_value(scenario, path)
        if path == "graph":
            wanted = not named and not scenario.schedule
        elif path == "topology" and scenario.schedule and not named:
            lines.append(f"topology = [\n{_stages(scenario.schedule)}]\n")
            continue
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


def _name_says_all(scenario: Scenario) -> bool:
    """Whether the name of the topology gives graph and schedule again."""
    from protocol.scenario.resolve import resolve
    from protocol.topology.named import TOPOLOGIES

    if scenario.topology not in TOPOLOGIES:
        return False
    try:
        again = resolve(structs.replace(scenario, graph=(), schedule=()), robots_given=True)
    except ScenarioError:
        return False
    return (again.graph, again.schedule) == (scenario.graph, scenario.schedule)


def _stages(stages: tuple[Stage, ...]) -> str:
    return "".join(f"    {_table(*structs.asdict(stage).items())},\n" for stage in stages)


def _inline(value: object) -> str:
    """A value in one line, as an inline table needs it."""
    return "[" + ", ".join(map(_inline, value)) + "]" if isinstance(value, tuple) else _toml(value)


def _table(*pairs: tuple[str, object]) -> str:
    return "{" + ", ".join(f"{name} = {_inline(value)}" for name, value in pairs) + "}"


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
            return _table(("kind", value.__struct_config__.tag), *((name, v) for name, v, default in given if v != default))
        case tuple() if value and isinstance(value[0], tuple | Fault):
            return "[\n" + "".join(f"    {_toml(each)},\n" for each in value) + "]"
        case tuple():
            return "[" + ", ".join(_toml(each) for each in value) + "]"
        case _:
            raise TypeError(f"no TOML form for {value!r}")
