"""`python -m deploy.recorder.screenshot FILE.rrd OUT.png`: a recording as a picture, without a display.

Rules: only for people and documentation, no run needs it. Rerun draws in a viewer without a window, which
needs a Vulkan driver; a software one will do (Debian: mesa-vulkan-drivers). The viewer's remote control is
experimental in Rerun.
"""

from __future__ import annotations

import argparse
import os
import socket
import sys
import time
from pathlib import Path

from rerun.experimental import ViewerClient

from deploy.recorder.chunks import SIM_TIME
from deploy.recorder.mend import mend
from protocol.errors import OdourswarmError

SETTLE = 2.0  # s in which the viewer's plots and time panel come to rest
LOAD = 60.0  # s that the viewer may take to load the file


def screenshot(recording: Path, picture: Path, at: float | None) -> None:
    """Draw `recording` at `at` simulated seconds (None: at its end) into the PNG file `picture`, 1920 x 1080.

    Raises: OdourswarmError when there is no such recording, or no viewer can draw here.
    """
    if not recording.is_file():
        raise OdourswarmError(f"there is no recording {recording}.")
    mend(recording)
    try:
        with ViewerClient.spawn(headless=True, port=_free_port(), memory_limit="1GiB") as viewer:
            viewer.open(str(recording.resolve()))
            viewer.set_time(SIM_TIME, duration=_end(viewer) if at is None else at, play_state="paused")
            time.sleep(SETTLE)
            viewer.save_screenshot(str(picture.resolve()))
    except (RuntimeError, TimeoutError, ConnectionError) as error:
        raise OdourswarmError(
            f"the viewer did not draw: {error}; without a graphics card it needs Debian's mesa-vulkan-drivers."
        ) from None


def _end(viewer: ViewerClient) -> float:
    """Last simulated second of the recording."""
    deadline = time.monotonic() + LOAD
    while time.monotonic() < deadline:
        for recording in viewer.get_state().recordings:
            for timeline in recording.timelines:
                if timeline.name == SIM_TIME and timeline.end is not None:
                    return 1e-9 * timeline.end
        time.sleep(0.1)
    raise TimeoutError(f"it did not load the recording within {LOAD:g} s")


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def main() -> int:
    """Make one picture; the exit status."""
    parser = argparse.ArgumentParser(prog="python -m deploy.recorder.screenshot")
    parser.add_argument("recording", type=Path, metavar="FILE.rrd")
    parser.add_argument("picture", type=Path, metavar="OUT.png")
    parser.add_argument("--at", type=float, metavar="T", help="simulated s; default: the end of the run")
    given = parser.parse_args()
    os.environ.setdefault("RUST_LOG", "error")  # the viewer is talkative
    try:
        screenshot(given.recording, given.picture, given.at)
    except OdourswarmError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
