"""Scenarios for tests: near the plume, so that a few simulated seconds see search, detection and tracing."""

from __future__ import annotations

from protocol.scenario import Scenario
from protocol.scenario.load import load_scenario


def near_the_plume(**values: object) -> Scenario:
    """A scenario that meets the odour within seconds; `values` with "__" for "." override it."""
    chosen: dict[str, object] = {"start.y": -6.0, "start.x": 60.0, "plume.warm_up": 120.0, "max_time": 8.0}
    chosen |= {name.replace("__", "."): value for name, value in values.items()}
    return load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])
