"""`python -m robot_agent`: a robot of a run that the launcher started; by hand use `odourswarm robot`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import msgspec

from protocol.errors import OdourswarmError
from protocol.scenario.place import RobotPlace
from protocol.shell import EXIT_FAILED, EXIT_OK, Stop, clean_up_after_launcher, leave, stop_on_signals
from robot_agent.process import RobotProcess


def main() -> int:
    """Run the robot; its exit status."""
    parser = argparse.ArgumentParser(prog="python -m robot_agent")
    parser.add_argument("--run", required=True)
    parser.add_argument("--place", type=Path, required=True)
    parser.add_argument("--leash", action="store_true")
    given = parser.parse_args()
    stop_on_signals(leash=given.leash)
    try:
        place = msgspec.json.decode(given.place.read_bytes(), type=RobotPlace)
        RobotProcess(given.run, place).serve()
    except OdourswarmError as error:
        print(error, file=sys.stderr)
        return EXIT_FAILED
    except Stop:
        return EXIT_OK
    finally:
        clean_up_after_launcher(given.place.parent)
    return EXIT_OK


if __name__ == "__main__":
    leave(main())
