"""What the shells of all processes share: being told to stop, and never outliving the launcher.

Rules: only shells (`process.py` modules, the launcher) use this; nothing pure does. A process that is told to stop
raises `Stop` in its main thread, wherever it waits.
"""

from __future__ import annotations

import gc
import os
import shutil
import signal
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import BinaryIO, NoReturn

from protocol.errors import OdourswarmError

EXIT_OK, EXIT_BAD_INPUT, EXIT_FAILED = 0, 2, 3
STDIN = Path("-")


_launcher_gone = threading.Event()
_parent = os.getppid()


class Stop(BaseException):
    """The process was told to stop; not an `Exception`, so that no handler of errors swallows it."""


def stop_on_signals(*, leash: bool) -> None:
    """Make SIGTERM and SIGINT raise `Stop`; with `leash`, the end of standard input too.

    The leash is a pipe that the launcher holds open: when the launcher is gone, however it died, the pipe ends and the
    process stops. SIGINT is ignored on a leash: a Ctrl-C at the terminal is the launcher's to handle.
    """
    signal.signal(signal.SIGTERM, _raise_stop)
    signal.signal(signal.SIGINT, signal.SIG_IGN if leash else _raise_stop)
    if leash:
        threading.Thread(target=_watch, args=(sys.stdin.buffer,), daemon=True, name="leash").start()


def handed_over(place: Path | None) -> bytes | None:
    """What the launcher hands over: the text of file `place`, or for "-" the first line of standard input, which is the
    leash from then on: so it reaches a process on another host, which has no file of ours. None: there is nothing.

    To be called before the leash is watched.
    """
    if place is None:
        return None
    return sys.stdin.buffer.readline() if place == STDIN else place.read_bytes()


def clean_up_after_launcher(folder: Path) -> None:
    """Remove the run's folder if the launcher, whose business that is, is gone.

    This process may end because others did, before its own leash is heard of; a parent that is gone shows at once.
    """
    if _launcher_gone.is_set() or os.getppid() != _parent:
        shutil.rmtree(folder, ignore_errors=True)


def settle_memory() -> None:
    """Everything is set up: take it out of the garbage collector's rounds, which a lock-step would feel."""
    gc.collect()
    gc.freeze()


def serve_until_done(serve: Callable[[], object], *, leash: bool, folder: Path | None) -> int:
    """Run a process of a run that the launcher started; its exit status. `folder`: the run's, if it has one here.

    What failed is one sentence on standard error, where the launcher reads it.
    """
    try:
        stop_on_signals(leash=leash)  # in here: a leash that has ended already stops at once
        serve()
    except OdourswarmError as error:
        print(error, file=sys.stderr)
        return EXIT_FAILED
    except Stop:
        return EXIT_OK
    finally:
        if folder is not None:
            clean_up_after_launcher(folder)
    return EXIT_OK


def ignore_signals() -> None:
    """From here on the process is ending by itself; do not interrupt that."""
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def leave(status: int) -> NoReturn:
    """End the process now.

    The middleware's threads can keep an interpreter from ending while a peer hangs; everything of ours is closed and
    flushed before this is called.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def _raise_stop(signum: int, frame: FrameType | None) -> NoReturn:
    raise Stop(f"signal {signum}")


def _watch(pipe: BinaryIO) -> None:
    while pipe.read(4096):
        pass
    _launcher_gone.set()
    # Raising in the main thread is what a signal does; os.kill also works on Windows for SIGTERM by ending the process.
    os.kill(os.getpid(), signal.SIGTERM)
