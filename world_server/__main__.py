"""`python -m world_server`: the world of a run that the launcher started; by hand use `odourswarm world`."""

from __future__ import annotations

import argparse
from pathlib import Path

import msgspec

from protocol.scenario import Scenario
from protocol.scenario.place import WorldPlace
from protocol.shell import EXIT_OK, handed_over, leave, serve_until_done
from world_server.process import WorldProcess


def main() -> int:
    """Run the world; its exit status."""
    parser = argparse.ArgumentParser(prog="python -m world_server")
    parser.add_argument("--run", required=True)
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument("--folder", type=Path, help="the run's, with scenario.json and endpoints.json")
    where.add_argument("--place", type=Path, help="both in one file; -: in the first line of standard input")
    parser.add_argument("--history", type=Path)
    parser.add_argument("--checkpoints", type=Path)
    for flag in ("--launcher", "--recorder", "--leash"):
        parser.add_argument(flag, action="store_true")
    given = parser.parse_args()

    handed = handed_over(given.place)
    if handed is not None and not handed:
        return EXIT_OK  # the launcher was gone before it said anything

    def serve() -> None:
        place = _read(given.folder) if handed is None else msgspec.json.decode(handed, type=WorldPlace)
        ended = WorldProcess(
            given.run,
            place.scenario,
            place.endpoints,
            recorder=given.recorder,
            launcher=given.launcher,
            history=given.history,
            checkpoints=given.checkpoints,
        ).serve()
        # For the launcher, should its link have been down when this was told.
        if given.folder is not None:
            (given.folder / "outcome.json").write_bytes(msgspec.json.encode(ended))

    return serve_until_done(serve, leash=given.leash, folder=given.folder)


def _read(folder: Path) -> WorldPlace:
    scenario = msgspec.json.decode((folder / "scenario.json").read_bytes(), type=Scenario)
    return WorldPlace(scenario, msgspec.json.decode((folder / "endpoints.json").read_bytes(), type=tuple[str, ...]))


if __name__ == "__main__":
    leave(main())
