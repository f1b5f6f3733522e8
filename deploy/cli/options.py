"""Flags that several commands share, and how they become scenario overrides."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NoReturn

from protocol.errors import OdourswarmError, ScenarioError
from protocol.history.file import refuse_used
from protocol.scenario import Scenario
from protocol.scenario.load import Override, load_scenario, parse_setting
from protocol.shell import EXIT_BAD_INPUT, EXIT_FAILED, Stop, leave, stop_on_signals
from robot_agent.algorithms import ALGORITHMS, refuse_declaring

INTERRUPTED = 130  # exit status after Ctrl-C, as shells give it


def read_scenario(
    file: Path | None,
    settings: Sequence[str],
    *,
    source: str | None = None,
    **flags: object,
) -> Scenario:
    """The scenario of a file, of `--set` and of flags; a flag that was not given is None.

    The order is: --preset and --case first (they are sets of values), then --set, then the other flags.
    """
    overrides: list[Override] = []
    for name in ("preset", "case"):
        if (value := flags.pop(name, None)) is not None:
            overrides.append((name, value, f"--{name}"))
    overrides += [(path, value, f"--set {path}") for path, value in map(parse_setting, settings)]
    if source is not None:
        x, y = _point(source)
        overrides += [("source.x", x, "--source"), ("source.y", y, "--source")]
    for flag, path in (("wind", "wind.speed"), ("stop", "declaration.stop"), ("fusion", "fusion.kind"),
                       ("restart", "supervision.restart"), ("checkpoint_every", "supervision.checkpoint_every"),
                       ("speed", "realtime.speed")):  # fmt: skip
        if (value := flags.pop(flag, None)) is not None:
            overrides.append((path, value, "--" + flag.replace("_", "-")))
    overrides += [(name, value, "--" + name.replace("_", "-")) for name, value in flags.items() if value is not None]
    scenario = load_scenario(file, overrides=overrides, algorithms=ALGORITHMS)
    refuse_declaring(scenario)
    return scenario


def checkpoint_folder(folder: Path | None, scenario: Scenario) -> None:
    """Make the folder of `--checkpoint`, if it is given.

    Raises: ScenarioError when it is not to be used.
    """
    if folder is None:
        return
    if not scenario.supervision.checkpoint_every:
        raise ScenarioError(f"--checkpoint is {folder}, and no checkpoint is due; add --checkpoint-every S.")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise ScenarioError(f"--checkpoint is {folder}; it must be a folder that can be made: {reason}.") from None


def prepare_history(folder: Path, *, new: bool = True) -> None:
    """Make the folder of `--history`.

    Args:
        new: whether it must be without histories; a member by hand may find those of others there.
    Raises: ScenarioError when it is not to be used.
    """
    if new:
        refuse_used(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise ScenarioError(f"--history is {folder}; the folder cannot be made ({reason}).") from None


def complain(error: Exception | str) -> None:
    """Print a sentence that is meant for the person at the terminal."""
    print(error, file=sys.stderr)


def be_a_member(serve: Callable[[], int]) -> NoReturn:
    """Be a process of a run by hand: `serve` gives the exit status; what fails is one sentence, a signal ends it."""
    stop_on_signals(leash=False)
    try:
        status = serve()
    except ScenarioError as error:
        complain(error)
        status = EXIT_BAD_INPUT
    except OdourswarmError as error:
        complain(error)
        status = EXIT_FAILED
    except Stop:
        status = INTERRUPTED
    leave(status)


def _point(text: str) -> tuple[float, float]:
    parts = text.split(",")
    try:
        x, y = (float(part) for part in parts)
    except ValueError:
        sentence = f'--source is "{text}"; it must be two numbers X,Y in metres, for example 30,-20.'
        raise ScenarioError(sentence) from None
    return x, y
