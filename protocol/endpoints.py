"""Endpoints: where the members of a run listen, as Zenoh writes it.

Rules: unix sockets live in the run's own directory and are gone with it; TCP ports are given, or free ones that the
system names. Zenoh removes a socket and its lock file when a session closes and takes over what a killed process left;
so cleaning up after a run means removing its directory, nothing else.
"""

from __future__ import annotations

import os
import socket
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from protocol.errors import ScenarioError
from protocol.keys import WORLD, robot_name

if TYPE_CHECKING:
    from protocol.scenario import Scenario

Transport = Literal["unix", "tcp"]
MAX_PATH = 103  # bytes of a unix socket's path: 108 with the final zero on Linux, 104 on macOS
HOST = "127.0.0.1"


def default_transport() -> Transport:
    """What members on one machine speak over."""
    return "tcp" if sys.platform == "win32" else "unix"


def unix_endpoint(folder: Path, name: str) -> str:
    """Endpoint of member `name` as a unix socket in `folder`.

    Raises:
        ScenarioError: the path is too long for a socket, or this system's Zenoh has no unix sockets.
    """
    if sys.platform == "win32":
        raise ScenarioError('network.transport is "unix", which Windows has not; use "tcp" or "auto".')
    path = folder.absolute() / f"{name.replace('/', '-')}.sock"
    if len(os.fsencode(path)) > MAX_PATH:
        raise ScenarioError(
            f"the socket path {path} has {len(os.fsencode(path))} bytes, a unix socket takes {MAX_PATH}; "
            f'set TMPDIR to a shorter directory or network.transport to "tcp".'
        )
    return f"unixsock-stream/{path}"


def free_tcp_endpoints(count: int, host: str = HOST) -> tuple[str, ...]:
    """`count` endpoints at TCP ports that are free now; somebody else may take one before it is listened at."""
    with ExitStack() as stack:
        ports = []
        for _ in range(count):
            # All are held until all are found, or the system would name the same one twice.
            probe = stack.enter_context(socket.socket())
            probe.bind((host, 0))
            ports.append(probe.getsockname()[1])
    return tuple(f"tcp/{host}:{port}" for port in ports)


def tcp_endpoints(first: int, count: int, host: str = HOST) -> tuple[str, ...]:
    """`count` endpoints at TCP ports `first`, `first` + 1, ...

    Raises:
        ScenarioError: there are not so many ports.
    """
    if not 0 < first <= 65536 - count:
        raise ScenarioError(
            f"network.port is {first}; for {count} processes it must be from 1 to {65536 - count}, or 0 for free ports."
        )
    return tuple(f"tcp/{host}:{first + k}" for k in range(count))


def make_endpoints(scenario: Scenario, folder: Path) -> tuple[str, ...]:
    """Endpoints of the world and then of each robot, for a run on this machine.

    Raises:
        ScenarioError: the scenario's wires cannot be had here.
    """
    network, count = scenario.network, scenario.robots + 1
    transport = default_transport() if network.transport == "auto" else network.transport
    if transport == "unix":
        names = (WORLD, *(robot_name(i) for i in range(scenario.robots)))
        return tuple(unix_endpoint(folder, name) for name in names)
    return tcp_endpoints(network.port, count) if network.port else free_tcp_endpoints(count)

