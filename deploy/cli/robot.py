"""`odourswarm robot`: one robot by hand, on any host."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from deploy.cli.options import be_a_member, prepare_history
from deploy.cli.world import check_run_name
from protocol.shell import EXIT_OK


def robot(
    world: Annotated[str, typer.Option("--world", help="Endpoint of the world, for example tcp/10.0.0.1:7447.")],
    robot: Annotated[int, typer.Option("--id", help="Number of this robot, from 0.")],
    run: Annotated[str, typer.Option("--run", help="Name of the run; the world gives the same.")],
    timeout: Annotated[float, typer.Option("--timeout", help="Wait this long for the world, s.")] = 30.0,
    history: Annotated[Path | None, typer.Option("--history", metavar="DIR", help="Write down what it did.")] = None,
    rejoin: Annotated[
        bool, typer.Option("--rejoin", help="The run has begun: take the place of a process that ended.")
    ] = False,
) -> None:
    """Be one robot: ask the world who I am, link up with my neighbours, take part until the run is over."""
    from robot_agent.process import RobotProcess, ask_place

    def serve() -> int:
        check_run_name(run)
        if history is not None:
            prepare_history(history, new=False)
        place = ask_place(run, robot, world, timeout)

        def say(text: str) -> None:
            print(f"robot {robot}: {text}", file=sys.stderr)

        RobotProcess(run, place, history, say, rejoin).serve()
        return EXIT_OK

    be_a_member(serve)
