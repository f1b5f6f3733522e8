"""docs/notation.md speaks of values and modules that exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from protocol.scenario.schema import tables, value_types

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "notation.md").read_text()
PACKAGES = ("protocol", "world_server", "robot_agent", "deploy")


def test_every_scenario_value_in_the_notation_exists() -> None:
    named = re.findall(r"`([a-z_]+\.[a-z_0-9]+)`", TEXT)
    values = [name for name in named if name.split(".")[0] in tables()]
    assert len(values) > 50
    assert [name for name in values if name not in value_types()] == []


@pytest.mark.parametrize("module", sorted(set(re.findall(rf"\b(?:{'|'.join(PACKAGES)})/[a-z_/]*(?:\.py)?", TEXT))))
def test_every_module_in_the_notation_exists(module: str) -> None:
    assert (ROOT / module).exists()
