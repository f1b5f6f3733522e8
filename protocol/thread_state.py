"""Keeping the interpreter's state of a foreign thread.

Rules: nothing depends on this but speed. A thread that was not started by Python gets an interpreter state for every
single call into Python and loses it afterwards; since Python 3.11 that includes mapping and unmapping the memory of its
stack of frames, some 25 microseconds, ten times what our callbacks do. A thread that once takes the interpreter lock
and does not give that one back keeps its state until the process ends.
"""

from __future__ import annotations

import ctypes
import sys
from threading import get_ident

_kept: set[int] = set()
_take_lock = ctypes.pythonapi.PyGILState_Ensure if sys.implementation.name == "cpython" else None


def keep_thread_state() -> None:
    """Keep the state of the calling thread, once; only for threads that live as long as the process."""
    me = get_ident()
    if me not in _kept:
        _kept.add(me)
        if _take_lock is not None:
            # Counted per thread: the caller's own pair of take and give stays balanced, only this one is kept.
            _take_lock()
