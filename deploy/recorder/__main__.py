"""`python -m deploy.recorder`: the recorder of a run that the launcher started."""

from __future__ import annotations

import argparse
from pathlib import Path

import msgspec

from deploy.recorder.process import RecorderProcess
from protocol.scenario import Scenario
from protocol.shell import leave, serve_until_done


def main() -> int:
    """Run the recorder; its exit status."""
    parser = argparse.ArgumentParser(prog="python -m deploy.recorder")
    parser.add_argument("--run", required=True)
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--record", type=Path)
    parser.add_argument("--view", action="store_true")
    parser.add_argument("--leash", action="store_true")
    given = parser.parse_args()

    def serve() -> None:
        scenario = msgspec.json.decode((given.folder / "scenario.json").read_bytes(), type=Scenario)
        endpoints = msgspec.json.decode((given.folder / "endpoints.json").read_bytes(), type=tuple[str, ...])
        RecorderProcess(given.run, scenario, endpoints, given.record, given.view).serve()

    return serve_until_done(serve, leash=given.leash, folder=given.folder)


if __name__ == "__main__":
    leave(main())
