"""The studies that come with odourswarm: sweeps by name."""

from __future__ import annotations

from pathlib import Path

from deploy.sweep.spec import Spec, read_spec
from protocol.errors import ScenarioError
from protocol.scenario.near import near
from protocol.scenario.schema import show

FOLDER = Path(__file__).parent.parent / "studies"


def names() -> list[str]:
    """What the studies are called."""
    return sorted(file.stem for file in FOLDER.glob("*.toml"))


def find_spec(name: str) -> Spec:
    """The sweep of a file, or of a study by its name.

    Raises: ScenarioError when there is none, or it is not right.
    """
    path = Path(name)
    if path.suffix or "/" in name or path.is_file():
        return read_spec(path)
    if name in names():
        return read_spec(FOLDER / f"{name}.toml")
    hint = near(name, names()) or "; `odourswarm sweep` lists the studies, a file's name ends in .toml."
    raise ScenarioError(f"there is no study {show(name)}{hint}")
