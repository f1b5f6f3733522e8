"""`odourswarm robot`: one robot by hand, on any host."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from deploy.cli.options import be_a_member
from deploy.cli.world import check_run_name
from protocol.shell import EXIT_OK


def robot(
    world: Annotated[str, typer.Option("--world", help="Endpoint of the world, for example tcp/10.0.0.1:7447.")],
    robot: Annotated[int, typer.Option("--id", help="Number of this robot, from 0.")],
    run: Annotated[str, typer.Option("--run", help="Name of the run; the world gives the same.")],
    timeout: Annotated[float, typer.Option("--timeout", help="Wait this long for the world, s.")] = 30.0,
) -> None:
    """Be one robot: ask the world who I am, link up with my neighbours, take part until the run is over."""
    from robot_agent.process import RobotProcess, ask_place

    def serve() -> int:
        check_run_name(run)
        place = ask_place(run, robot, world, timeout)
        RobotProcess(run, place, say=lambda text: print(f"robot {robot}: {text}", file=sys.stderr)).serve()
        return EXIT_OK

    be_a_member(serve)
