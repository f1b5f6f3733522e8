"""Flags that several commands share, and how they become scenario overrides."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from protocol.errors import ScenarioError
from protocol.scenario import Scenario
from protocol.scenario.load import Override, load_scenario, parse_setting
from robot_agent.algorithms import ALGORITHMS


def read_scenario(
    file: Path | None,
    settings: Sequence[str],
    *,
    source: str | None = None,
    **flags: object,
) -> Scenario:
    """The scenario of a file, of `--set` and of flags; a flag that was not given is None.

    The order is: --preset and --case first (they are sets of values), then --set, then the other flags.
    """
    overrides: list[Override] = []
    for name in ("preset", "case"):
        if (value := flags.pop(name, None)) is not None:
            overrides.append((name, value, f"--{name}"))
    overrides += [(path, value, f"--set {path}") for path, value in map(parse_setting, settings)]
    if source is not None:
        x, y = _point(source)
        overrides += [("source.x", x, "--source"), ("source.y", y, "--source")]
    if (wind := flags.pop("wind", None)) is not None:
        overrides.append(("wind.speed", wind, "--wind"))
    overrides += [(name, value, "--" + name.replace("_", "-")) for name, value in flags.items() if value is not None]
    return load_scenario(file, overrides=overrides, algorithms=ALGORITHMS)


def complain(error: Exception | str) -> None:
    """Print a sentence that is meant for the person at the terminal."""
    print(error, file=sys.stderr)


def _point(text: str) -> tuple[float, float]:
    parts = text.split(",")
    try:
        x, y = (float(part) for part in parts)
    except ValueError:
        sentence = f'--source is "{text}"; it must be two numbers X,Y in metres, for example 30,-20.'
        raise ScenarioError(sentence) from None
    return x, y
