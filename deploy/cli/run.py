"""`odourswarm run`: a world, N robots and, when wanted, a recorder, on this machine."""

from __future__ import annotations

import secrets
import signal
from pathlib import Path
from types import FrameType
from typing import Annotated, NoReturn

import typer
from typer import Argument, Option

from deploy.cli.advice import advice
from deploy.cli.options import INTERRUPTED, checkpoint_folder, complain, prepare_history, read_scenario
from deploy.hosts.seats import Seats, read_seats
from protocol.errors import ScenarioError, SwarmFailure
from protocol.messages import Outcome
from protocol.scenario import Scenario
from protocol.shell import EXIT_BAD_INPUT, EXIT_FAILED


def run(
    file: Annotated[Path | None, Argument(metavar="[SCENARIO.toml]", help="A scenario file; none: the default.")] = None,
    robots: Annotated[int | None, Option("--robots", "-n", help="Number of robots.")] = None,
    algorithm: Annotated[str | None, Option("--algorithm", "-a", help="One of `odourswarm algorithms`.")] = None,
    topology: Annotated[str | None, Option("--topology", "-t", help="A named graph, or a graph file.")] = None,
    case: Annotated[int | None, Option("--case", help="Source and wind of Table 4.6, 1 to 9.")] = None,
    source: Annotated[str | None, Option("--source", metavar="X,Y", help="Where the source is, m.")] = None,
    wind: Annotated[float | None, Option("--wind", metavar="U", help="Mean wind speed, m/s.")] = None,
    seed: Annotated[int | None, Option("--seed", help="All randomness follows from it.")] = None,
    fusion: Annotated[str | None, Option("--fusion", help="plain (3.26), or resilient: withstands liars.")] = None,
    max_time: Annotated[float | None, Option("--max-time", metavar="T", help="Give up after T simulated s.")] = None,
    preset: Annotated[str | None, Option("--preset", help="corrected, or literal as the thesis prints it.")] = None,
    stop: Annotated[
        str | None, Option("--stop", help="reached: a robot is at the source; declared: the swarm says where it is.")
    ] = None,
    setting: Annotated[list[str] | None, Option("--set", metavar="KEY=VALUE", help="Any scenario value.")] = None,
    clock: Annotated[
        str | None, Option("--clock", help="lockstep: as fast as the machine goes; realtime: nobody is waited for.")
    ] = None,
    speed: Annotated[float | None, Option("--speed", metavar="F", help="Real time: simulated s per s.")] = None,
    bus: Annotated[str, Option("--bus", help="zenoh: a process each; memory: one process.")] = "zenoh",
    record: Annotated[Path | None, Option("--record", metavar="FILE.rrd", help="Record the run for Rerun.")] = None,
    view: Annotated[bool, Option("--view", help="Watch the run in Rerun while it goes on.")] = False,
    history: Annotated[
        Path | None, Option("--history", metavar="DIR", help="Everyone writes down what it did, for `check`.")
    ] = None,
    restart: Annotated[
        str | None, Option("--restart", help="Robots whose process ends: never, crashed, always started again.")
    ] = None,
    checkpoint_every: Annotated[
        float | None, Option("--checkpoint-every", metavar="S", help="The world can come back from the last S simulated s.")
    ] = None,
    checkpoint: Annotated[
        Path | None, Option("--checkpoint", metavar="DIR", help="Where the checkpoints are kept while the run goes on.")
    ] = None,
    hosts: Annotated[
        Path | None, Option("--hosts", metavar="FILE.toml", help="Which process runs on which host, over TCP.")
    ] = None,
    json: Annotated[bool, Option("--json", help="One JSON object on stdout and nothing else.")] = False,
) -> None:
    """Let a swarm search for the source, and say whether it found it."""
    try:
        _choice("--bus", bus, ("zenoh", "memory"))
        _writable(record)
        if history is not None:
            prepare_history(history)
        scenario = read_scenario(
            file, setting or [], source=source, preset=preset, case=case, robots=robots, algorithm=algorithm,
            topology=topology, wind=wind, seed=seed, max_time=max_time, stop=stop, fusion=fusion, clock=clock, speed=speed,
            restart=restart, checkpoint_every=checkpoint_every,
        )  # fmt: skip
        _fits(scenario, bus, speed)
        if bus == "memory":
            _no_processes(restart, checkpoint_every)
        checkpoint_folder(checkpoint, scenario)
        seats = _seats(hosts, scenario, bus, checkpoint)
    except ScenarioError as error:
        complain(error)
        raise typer.Exit(EXIT_BAD_INPUT) from None
    for sentence in advice(scenario):
        complain(f"warning: {sentence}")
    signal.signal(signal.SIGTERM, _terminate)
    name = f"run-{secrets.token_hex(4)}"
    try:
        outcome = _execute(name, scenario, bus, record, view, history, checkpoint, seats, quiet=json)
    except SwarmFailure as error:
        complain(error)
        raise typer.Exit(EXIT_FAILED) from None
    except KeyboardInterrupt:
        complain("interrupted; all processes have ended" + _left_behind(record))
        raise typer.Exit(INTERRUPTED) from None
    _print(outcome, scenario, record, json=json)
    raise typer.Exit(EXIT_FAILED if outcome.failed else 0)


def _execute(
    name: str,
    scenario: Scenario,
    bus: str,
    record: Path | None,
    view: bool,
    history: Path | None,
    checkpoint: Path | None,
    seats: Seats | None,
    *,
    quiet: bool,
) -> Outcome:
    from deploy.cli.progress import Display

    with Display(scenario, quiet=quiet) as display:
        if bus == "memory":
            from deploy.memory_watch import run_watched

            return run_watched(name, scenario, display, record, view=view, history=history)
        from deploy.launch.swarm import SwarmRun

        return SwarmRun(name, scenario, record, view, history, checkpoint=checkpoint, seats=seats).execute(display)


def _print(outcome: Outcome, scenario: Scenario, record: Path | None, *, json: bool) -> None:
    if json:
        import msgspec

        typer.echo(msgspec.json.encode(msgspec.structs.asdict(outcome)).decode())
    else:
        from deploy.cli.verdict import print_verdict

        print_verdict(outcome, scenario, record)


def _choice(flag: str, value: str, allowed: tuple[str, ...]) -> None:
    if value not in allowed:
        raise ScenarioError(f'{flag} is "{value}"; it must be {" or ".join(allowed)}.')


def _fits(scenario: Scenario, bus: str, speed: float | None) -> None:
    if scenario.clock == "realtime" and bus == "memory":
        raise ScenarioError('--bus is "memory", and the clock is realtime; one process runs in lock-step only: --bus zenoh.')
    if scenario.clock == "lockstep" and speed is not None:
        raise ScenarioError(f"--speed is {speed:g}, and lock-step goes as fast as the machine; add --clock realtime.")


def _no_processes(restart: str | None, checkpoint_every: float | None) -> None:
    """Refuse what is asked for the sake of processes that end, where there are none."""
    for flag, value in (("--restart", restart if restart != "never" else None), ("--checkpoint-every", checkpoint_every)):
        if value:
            given = f'"{value}"' if isinstance(value, str) else f"{value:g}"
            raise ScenarioError(
                f'{flag} is {given}, and --bus is "memory": one process has no others to start again; leave {flag} out, or'
                " --bus zenoh."
            )


def _seats(file: Path | None, scenario: Scenario, bus: str, checkpoint: Path | None) -> Seats | None:
    if file is None:
        return None
    if bus == "memory":
        raise ScenarioError(f'--hosts is {file}, and --bus is "memory"; one process runs on one host: --bus zenoh.')
    if scenario.network.endpoints:
        raise ScenarioError(f"--hosts is {file}, and network.endpoints is given, too; leave one of them out.")
    if scenario.supervision.checkpoint_every and checkpoint is None:
        raise ScenarioError(f"--hosts is {file}, and checkpoints are due; add --checkpoint DIR, on the world's host.")
    return read_seats(file, scenario.robots)


def _writable(record: Path | None) -> None:
    if record is None:
        return
    if record.is_dir() or not record.resolve().parent.is_dir():
        raise ScenarioError(f"--record is {record}; it must be a file in a folder that exists.")


def _left_behind(record: Path | None) -> str:
    return f", and {record} holds what was recorded." if record is not None else "."


def _terminate(signum: int, frame: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt
