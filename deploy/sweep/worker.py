"""`python -m deploy.sweep.worker [--check]`: runs scenarios in memory, one after the other, and checks them when asked to.

A line of JSON comes in for each scenario, one goes out for each outcome. Rules: standard input is the leash; when it ends
the process ends at once, in the middle of a run, for whoever wanted the outcome is gone. A Ctrl-C at the terminal is the
sweep's to handle.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import traceback
from pathlib import Path
from queue import SimpleQueue

import msgspec

from protocol.errors import OdourswarmError
from protocol.messages import Outcome
from protocol.scenario import Scenario


class Answer(msgspec.Struct, frozen=True, omit_defaults=True):
    """Worker to sweep: `ready` once, then an outcome or the sentence that says why there is none."""

    ready: bool = False
    outcome: Outcome | None = None
    error: str = ""
    broken: str | None = None  # name of the first promise that was broken, "": none; None: it was not checked


def main() -> None:
    """Serve until the leash ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # Whatever else is printed must not get among the answers.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    tasks: SimpleQueue[bytes] = SimpleQueue()
    threading.Thread(target=_read, args=(tasks,), daemon=True, name="leash").start()
    encoder = msgspec.json.Encoder()
    run = _checked if "--check" in sys.argv[1:] else _plain
    answer = Answer(ready=True)
    while True:
        answers.write(encoder.encode(answer) + b"\n")
        answers.flush()
        try:
            answer = run(msgspec.json.decode(tasks.get(), type=Scenario))
        except OdourswarmError as error:
            answer = Answer(error=str(error))
        except Exception as error:
            answer = Answer(error=_sentence(error))


def _plain(scenario: Scenario) -> Answer:
    from deploy.memory_run import run_in_memory

    return Answer(outcome=run_in_memory(scenario, run="sweep"))


def _checked(scenario: Scenario) -> Answer:
    """The same run, with a history that is looked at and forgotten."""
    from deploy.checkers.check import read_memory, unplanned
    from deploy.memory_run import run_in_memory
    from protocol.history.file import HistoryMemory

    histories = HistoryMemory()
    outcome = run_in_memory(scenario, run="sweep", history=histories)
    broken = unplanned(read_memory(histories))
    return Answer(outcome=outcome, broken=broken[0].name if broken else "")


def _read(tasks: SimpleQueue[bytes]) -> None:
    for line in sys.stdin.buffer:
        tasks.put(line)
    os._exit(0)


def _sentence(error: Exception) -> str:
    """What went wrong in a run, and where in the code."""
    place = traceback.extract_tb(error.__traceback__)[-1]
    what = " ".join(str(error).split())
    return f"{type(error).__name__} in {Path(place.filename).name}, line {place.lineno}: {what}"


if __name__ == "__main__":
    main()
