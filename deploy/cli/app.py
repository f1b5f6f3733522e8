"""`odourswarm`: the commands, registered."""

from __future__ import annotations

import sys

import typer

from deploy.cli.algorithms import algorithms
from deploy.cli.check import check
from deploy.cli.reproduce import reproduce
from deploy.cli.robot import robot
from deploy.cli.run import run
from deploy.cli.sweep import sweep
from deploy.cli.topology import topology
from deploy.cli.view import view
from deploy.cli.world import world
from protocol.shell import EXIT_BAD_INPUT

app = typer.Typer(
    help="A swarm of robots, one process each, finds an odour source (Qiang Lu's thesis, 2013, over Zenoh).",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
for command in (run, world, robot, topology, algorithms, sweep, reproduce, check, view):
    app.command()(command)


def main() -> None:
    """The entry point: what the command line itself refuses is one sentence, too."""
    try:
        # Without its standalone mode, typer returns the exit status of a command that ended with one.
        sys.exit(app(standalone_mode=False) or 0)
    except typer.Abort:
        sys.exit(130)
    except Exception as error:
        # Click's own errors about flags: what it says is a sentence already; everything else is a bug and shows itself.
        message = getattr(error, "format_message", None)
        if message is None:
            raise
        print(" ".join(message().split()), file=sys.stderr)
        sys.exit(EXIT_BAD_INPUT)
