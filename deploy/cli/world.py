"""`odourswarm world`: the world of a run by hand, on any host."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from deploy.cli.options import be_a_member, checkpoint_folder, complain, prepare_history, read_scenario
from protocol.errors import ScenarioError
from protocol.keys import RUN_NAME
from protocol.shell import EXIT_BAD_INPUT, EXIT_FAILED, EXIT_OK


def world(
    run: Annotated[str, typer.Option("--run", help="Name of the run; the robots give the same.")],
    file: Annotated[Path | None, typer.Argument(metavar="[SCENARIO.toml]")] = None,
    setting: Annotated[list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Any scenario value.")] = None,
    recorder: Annotated[bool, typer.Option("--recorder", help="Wait for a recorder before the start.")] = False,
    history: Annotated[Path | None, typer.Option("--history", metavar="DIR", help="Write down what it did.")] = None,
    checkpoint: Annotated[
        Path | None,
        typer.Option("--checkpoint", metavar="DIR", help="Keep checkpoints there, and go on from one of this run."),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="The outcome as one JSON object.")] = False,
) -> None:
    """Own the plume, the physics and the clock of a run; start when all robots have joined.

    The endpoints stand in the scenario, the world's first: network.endpoints = ["tcp/10.0.0.1:7447", ...].
    """
    try:
        check_run_name(run)
        scenario = read_scenario(file, setting or [])
        checkpoint_folder(checkpoint, scenario)
        if history is not None:
            prepare_history(history, new=False)
        if not scenario.network.endpoints:
            raise ScenarioError(
                "network.endpoints is empty; a world by hand needs its own endpoint and one per robot, "
                f'for example --set \'network.endpoints=["tcp/0.0.0.0:7447", ...]\' with {scenario.robots + 1} of them.'
            )
    except ScenarioError as error:
        complain(error)
        raise typer.Exit(EXIT_BAD_INPUT) from None
    from world_server.process import WorldProcess

    def serve() -> int:
        endpoints = scenario.network.endpoints
        process = WorldProcess(run, scenario, endpoints, recorder=recorder, history=history, checkpoints=checkpoint)
        outcome = process.serve()
        if json:
            import msgspec

            typer.echo(msgspec.json.encode(msgspec.structs.asdict(outcome)).decode())
        else:
            from deploy.cli.verdict import print_verdict

            print_verdict(outcome, scenario, None)
        return EXIT_FAILED if outcome.failed else EXIT_OK

    be_a_member(serve)


def check_run_name(run: str) -> None:
    """Refuse a name that cannot stand in a key expression."""
    if not RUN_NAME.fullmatch(run):
        raise ScenarioError(f'--run is "{run}"; it must be letters, digits, ".", "_" and "-", at most 64 of them.')
