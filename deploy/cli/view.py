"""`odourswarm view FILE.rrd`: a recording in Rerun."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Annotated

import typer

from deploy.cli.options import complain
from deploy.recorder.mend import mend
from protocol.errors import ScenarioError
from protocol.shell import EXIT_BAD_INPUT


def view(
    file: Annotated[Path, typer.Argument(metavar="FILE.rrd", help="A recording made with run --record.")],
    web: Annotated[bool, typer.Option("--web", help="In a browser instead of a window.")] = False,
) -> None:
    """Open a recording in Rerun, in a window or a browser."""
    if not file.is_file():
        complain(ScenarioError(f"there is no recording {file}; make one with `odourswarm run --record {file}`."))
        raise typer.Exit(EXIT_BAD_INPUT)
    # A recorder that was killed may have left half a message at the end, which the viewer does not forgive.
    mend(file)
    command = [sys.executable, "-m", "rerun", "--memory-limit", "25%", *(["--web-viewer"] if web else []), str(file)]
    raise typer.Exit(subprocess.run(command, check=False).returncode)
