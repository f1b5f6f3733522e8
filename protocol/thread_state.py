"""Keeping the interpreter's state of a foreign thread.

Rules: nothing depends on this but speed. A thread that was not started by Python gets an interpreter state for every
single call into Python and loses it afterwards; since Python 3.11 that includes mapping and unmapping the memory for
its frames, some 25 microseconds, ten times what our callbacks do. A thread that once takes the interpreter lock and
does not give that one back keeps its state until the process ends, and with it whatever is local to it.
"""

from __future__ import annotations

import ctypes
import sys
from threading import local

_of_thread = local()
_take_lock = ctypes.pythonapi.PyGILState_Ensure if sys.implementation.name == "cpython" else lambda: 0


def keep_thread_state() -> None:
    """Keep the state of the calling thread; for the threads of a pool, which are few and live long."""
    try:
        _of_thread.kept  # noqa: B018 - a state that was kept knows it
    except AttributeError:
        _of_thread.kept = True
        # Counted per thread: the caller's own pair of take and give stays balanced, only this one is never given back.
        _take_lock()
