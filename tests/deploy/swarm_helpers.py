"""Scenarios for tests: near the plume, so that a few simulated seconds see search, detection and tracing."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import psutil
import pytest

from protocol.scenario import Scenario
from protocol.scenario.load import load_scenario


def near_the_plume(**values: object) -> Scenario:
    """A scenario that meets the odour within seconds; `values` with "__" for "." override it."""
    chosen: dict[str, object] = {"start.y": -6.0, "start.x": 60.0, "plume.warm_up": 120.0, "max_time": 8.0}
    chosen |= {name.replace("__", "."): value for name, value in values.items()}
    return load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()])


MODULES = ("world_server", "robot_agent", "deploy.recorder", "deploy.cli")


@contextmanager
def folder_left_clean(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A temporary folder of the test's own, short enough for sockets; after the test it is empty and nobody lives.

    Whoever does live is killed, so that one test's failure is not the next one's.
    """
    with tempfile.TemporaryDirectory(prefix="t-") as name:
        monkeypatch.setattr(tempfile, "tempdir", name)
        monkeypatch.setenv("TMPDIR", name)
        yield Path(name)
        left = []
        for process in psutil.Process().children(recursive=True):
            with suppress(psutil.NoSuchProcess):
                line = " ".join(process.cmdline())
                if any(module in line for module in MODULES):
                    left.append(line)
                    process.kill()
        assert left == []
        assert list(Path(name).glob("odour-*")) == []
