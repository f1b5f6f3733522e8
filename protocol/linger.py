"""Sockets that are closed at once, also when what they hold cannot be sent any more.

Zenoh has its TCP sockets linger (SO_LINGER, 10 s): closing one whose cable is cut then holds up the thread that closes
it, and that is the thread that receives from everybody (eclipse-zenoh issues 1101 and 2350). Without it the system sends
on in the background what there is to send, as it does by default.

Rules: a shell's. It touches sockets of this process that linger, nothing else, and neither opens nor closes any.
"""

from __future__ import annotations

import os
import socket
import struct
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

FILES = Path("/dev/fd")  # what this process has open, on Linux and macOS
_LINGER = struct.Struct("ii")  # on or off, s


def over_tcp(endpoints: Iterable[str]) -> bool:
    """Whether any of these endpoints is a TCP socket."""
    return any(endpoint.startswith(("tcp/", "tls/")) for endpoint in endpoints)


def lingering() -> list[int]:
    """File numbers of the sockets that linger."""
    return [number for number in _open_files() if _lingers(number)]


def let_go() -> None:
    """Let no socket of this process linger from now on. Where the system lists no open files, nothing happens."""
    for number in _open_files():
        _lingers(number, stop=True)


def _open_files() -> list[int]:
    with suppress(OSError):
        return [int(name) for name in os.listdir(FILES)]
    return []


def _lingers(number: int, *, stop: bool = False) -> bool:
    with suppress(OSError):  # no socket, or closed in between
        one = socket.socket(fileno=number)
        try:
            on, _ = _LINGER.unpack(one.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _LINGER.size))
            if on and stop:
                one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _LINGER.pack(0, 0))
            return bool(on)
        finally:
            one.detach()
    return False
