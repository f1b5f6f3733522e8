"""A result on disk: one PNG a picture, one Markdown page, one JSON with the numbers.

Rules: a file is complete or not there: it is written beside its place and moved.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path
from tempfile import TemporaryFile

import msgspec

from deploy.reproduce.kinds import Reproduction, Result
from deploy.reproduce.markdown import page
from protocol.errors import ScenarioError

DPI = 120


def prepare(folder: Path) -> None:
    """Make `folder`, if it is not there.

    Raises: ScenarioError when nothing can be written there.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        TemporaryFile(dir=folder).close()
    except OSError as error:
        raise _cannot(folder, error) from None


def write(reproduction: Reproduction, result: Result, folder: Path) -> list[Path]:
    """Write the result under `folder`; the files: the pictures, the page, then the numbers.

    Raises: ScenarioError when that fails (a full disk).
    """
    record = {
        "name": reproduction.name,
        "title": reproduction.title,
        "place": reproduction.place,
        "rows": [asdict(row) for row in result.rows],
        "numbers": result.numbers,
    }
    text = msgspec.json.format(msgspec.json.encode(record, enc_hook=_plain), indent=2)
    pictures = {
        folder / f"{reproduction.name}{'-' + ending if ending else ''}.png": figure
        for ending, figure in result.figures.items()
    }
    words = folder / f"{reproduction.name}.md"
    numbers = folder / f"{reproduction.name}.json"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for path, figure in pictures.items():
            _place(path, partial(figure.savefig, format="png", dpi=DPI, bbox_inches="tight"))
        told = page(reproduction, result, [path.name for path in pictures])
        _place(words, lambda part: part.write_text(told, encoding="utf-8"))
        _place(numbers, lambda part: part.write_bytes(text + b"\n"))
    except OSError as error:
        raise _cannot(folder, error) from None
    return [*pictures, words, numbers]


def _plain(value: object) -> object:
    """numpy's numbers and arrays as Python's."""
    plain = getattr(value, "tolist", None)
    if plain is None:
        raise TypeError(f"{type(value).__name__} cannot stand in a JSON file")
    return plain()


def _cannot(folder: Path, error: OSError) -> ScenarioError:
    return ScenarioError(f"--out is {folder}; it must be a folder that can be written ({error.strerror or error}).")


def _place(path: Path, fill: Callable[[Path], object]) -> None:
    part = path.with_name(path.name + ".part")
    try:
        fill(part)
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)
