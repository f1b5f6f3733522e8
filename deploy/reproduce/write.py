"""A result on disk: one PNG a picture, one JSON with the numbers.

Rules: a file is complete or not there: it is written beside its place and moved.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

import msgspec

from deploy.reproduce.kinds import Reproduction, Result


def write(reproduction: Reproduction, result: Result, folder: Path) -> list[Path]:
    """Write the result under `folder`; the files, in the order in which they were written."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for ending, figure in result.figures.items():
        path = folder / f"{reproduction.name}{'-' + ending if ending else ''}.png"

        def draw(part: Path, figure: object = figure) -> None:
            figure.savefig(part, format="png", dpi=120, bbox_inches="tight")  # type: ignore[attr-defined]

        _place(path, draw)
        written.append(path)
    path = folder / f"{reproduction.name}.json"
    record = {
        "name": reproduction.name,
        "title": reproduction.title,
        "place": reproduction.place,
        "rows": [asdict(row) for row in result.rows],
        "numbers": result.numbers,
    }
    text = msgspec.json.format(msgspec.json.encode(record), indent=2)
    _place(path, lambda part: part.write_bytes(text + b"\n"))
    written.append(path)
    return written


def _place(path: Path, fill: Callable[[Path], object]) -> None:
    part = path.with_name(path.name + ".part")
    try:
        fill(part)
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)
