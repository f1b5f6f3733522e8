"""`python -m robot_agent`: a robot of a run that the launcher started; by hand use `odourswarm robot`."""

from __future__ import annotations

import argparse
from pathlib import Path

import msgspec

from protocol.scenario.place import RobotPlace
from protocol.shell import EXIT_OK, STDIN, handed_over, leave, serve_until_done
from robot_agent.process import RobotProcess


def main() -> int:
    """Run the robot; its exit status."""
    parser = argparse.ArgumentParser(prog="python -m robot_agent")
    parser.add_argument("--run", required=True)
    parser.add_argument("--place", type=Path, required=True, help="a file; -: the first line of standard input")
    parser.add_argument("--history", type=Path)
    for flag in ("--leash", "--rejoin"):
        parser.add_argument(flag, action="store_true")
    given = parser.parse_args()

    if not (handed := handed_over(given.place)):
        return EXIT_OK  # the launcher was gone before it said anything

    def serve() -> None:
        place = msgspec.json.decode(handed, type=RobotPlace)
        RobotProcess(given.run, place, history=given.history, rejoin=given.rejoin).serve()

    return serve_until_done(serve, leash=given.leash, folder=None if given.place == STDIN else given.place.parent)


if __name__ == "__main__":
    leave(main())
