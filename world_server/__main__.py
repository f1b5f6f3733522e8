"""`python -m world_server`: the world of a run that the launcher started; by hand use `odourswarm world`."""

from __future__ import annotations

import argparse
from pathlib import Path

import msgspec

from protocol.scenario import Scenario
from protocol.shell import leave, serve_until_done
from world_server.process import WorldProcess


def main() -> int:
    """Run the world; its exit status."""
    parser = argparse.ArgumentParser(prog="python -m world_server")
    parser.add_argument("--run", required=True)
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--history", type=Path)
    parser.add_argument("--checkpoints", type=Path)
    for flag in ("--launcher", "--recorder", "--leash"):
        parser.add_argument(flag, action="store_true")
    given = parser.parse_args()

    def serve() -> None:
        scenario = msgspec.json.decode((given.folder / "scenario.json").read_bytes(), type=Scenario)
        endpoints = msgspec.json.decode((given.folder / "endpoints.json").read_bytes(), type=tuple[str, ...])
        ended = WorldProcess(
            given.run,
            scenario,
            endpoints,
            recorder=given.recorder,
            launcher=given.launcher,
            history=given.history,
            checkpoints=given.checkpoints,
        ).serve()
        # For the launcher, should its link have been down when this was told.
        (given.folder / "outcome.json").write_bytes(msgspec.json.encode(ended))

    return serve_until_done(serve, leash=given.leash, folder=given.folder)


if __name__ == "__main__":
    leave(main())
