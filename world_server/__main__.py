"""`python -m world_server`: the world of a run that the launcher started; by hand use `odourswarm world`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import msgspec

from protocol.errors import OdourswarmError
from protocol.scenario import Scenario
from protocol.shell import EXIT_FAILED, EXIT_OK, Stop, clean_up_after_launcher, leave, stop_on_signals
from world_server.process import WorldProcess


def main() -> int:
    """Run the world; its exit status."""
    parser = argparse.ArgumentParser(prog="python -m world_server")
    parser.add_argument("--run", required=True)
    parser.add_argument("--folder", type=Path, required=True)
    for flag in ("--launcher", "--recorder", "--leash"):
        parser.add_argument(flag, action="store_true")
    given = parser.parse_args()
    stop_on_signals(leash=given.leash)
    try:
        scenario = msgspec.json.decode((given.folder / "scenario.json").read_bytes(), type=Scenario)
        endpoints = msgspec.json.decode((given.folder / "endpoints.json").read_bytes(), type=tuple[str, ...])
        WorldProcess(given.run, scenario, endpoints, recorder=given.recorder, launcher=given.launcher).serve()
    except OdourswarmError as error:
        print(error, file=sys.stderr)
        return EXIT_FAILED
    except Stop:
        return EXIT_OK
    finally:
        clean_up_after_launcher(given.folder)
    return EXIT_OK


if __name__ == "__main__":
    leave(main())
