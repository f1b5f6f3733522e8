"""Which member of a run lives on which host: the file of `odourswarm run --hosts`.

    port = 7447                      # a host's first member listens there, the next one at port + 1, ...
    python = "/opt/odour/bin/python" # the interpreter on the hosts that name none; none at all: the launcher's own

    [[hosts]]
    address = "10.0.0.1"             # where the others reach its members, and where these listen
    world = true

    [[hosts]]
    address = "10.0.0.2"
    through = "ssh lab-2"            # put before the command that starts a member there; none: it starts here
    robots = [0, 1]

Rules: an experiment's matter, no scenario value: the same scenario has the same digest wherever it runs. The launcher
hands a member what it needs over the pipe to `through`, so that a host has nothing but the installed package. The member
ends when that pipe does. Every refusal is one sentence.
"""

from __future__ import annotations

import ipaddress
import re
import shlex
import shutil
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import msgspec
from msgspec import Meta

from protocol import keys
from protocol.errors import ScenarioError
from protocol.scenario.table import Table
from protocol.scenario.toml_file import read_toml

MAX_PORT = 65535
_NAME = re.compile(r"[A-Za-z0-9]([A-Za-z0-9._-]*[A-Za-z0-9])?")


class Host(Table, frozen=True):
    """An address, and who runs there."""

    address: str
    through: str = ""
    python: str = ""
    world: bool = False
    robots: tuple[Annotated[int, Meta(ge=0, le=999)], ...] = ()


class HostsFile(Table, frozen=True):
    """The file."""

    hosts: Annotated[tuple[Host, ...], Meta(min_length=1)]
    port: Annotated[int, Meta(ge=1, le=MAX_PORT)] = 7447
    python: str = ""


@dataclass(frozen=True, slots=True)
class Seat:
    """Where one member runs."""

    endpoint: str
    through: tuple[str, ...]  # what its command begins with
    python: str  # the interpreter there


@dataclass(frozen=True, slots=True)
class Seats:
    """Where everybody runs, by member: "world", "robot/3"."""

    members: Mapping[str, Seat]

    @property
    def endpoints(self) -> tuple[str, ...]:
        """The world's, then each robot's."""
        robots = range(len(self.members) - 1)
        return tuple(self.members[name].endpoint for name in (keys.WORLD, *map(keys.robot_name, robots)))


def read_seats(file: Path, robots: int) -> Seats:
    """The seats of a run of `robots` robots.

    Raises: ScenarioError.
    """
    try:
        given = msgspec.convert(read_toml(file, "a file of hosts"), HostsFile)
    except msgspec.ValidationError as error:
        reason, _, place = str(error).partition(" - at `$")
        where = f"{file}: {place.strip('`.')}: " if place else f"{file}: "
        known = "a file of hosts has port, python and [[hosts]], each with address, through, python, world and robots"
        raise ScenarioError(f"{where}{reason[:1].lower()}{reason[1:]}; {known}.") from None
    members: dict[str, Seat] = {}
    taken: dict[str, int] = {}  # by address: how many listen there
    for n, host in enumerate(given.hosts, 1):
        origin = f"{file} [[hosts]] {n}"
        address, through = _address(host.address, origin), _through(host.through, origin)
        for name in ([keys.WORLD] if host.world else []) + [keys.robot_name(i) for i in host.robots]:
            if name in members:
                raise ScenarioError(f"{origin}: {_said(name)} has a host already; each member has one.")
            port = given.port + taken.get(address, 0)
            if port > MAX_PORT:
                raise ScenarioError(f"{origin}: no port is left for {_said(name)}; choose a port below {given.port}.")
            taken[address] = taken.get(address, 0) + 1
            members[name] = Seat(f"tcp/{address}:{port}", through, host.python or given.python or sys.executable)
    wanted = [keys.WORLD, *map(keys.robot_name, range(robots))]
    if missing := [name for name in wanted if name not in members]:
        raise ScenarioError(f"{file}: {', '.join(map(_said, missing))} has no host; name it in one of [[hosts]].")
    if extra := [name for name in members if name not in wanted]:
        raise ScenarioError(
            f"{file}: {', '.join(map(_said, extra))} is not of this run, which has robots 0 to {robots - 1}; leave it out."
        )
    return Seats(members)


def _address(text: str, origin: str) -> str:
    """As it stands in an endpoint."""
    try:
        parsed = ipaddress.ip_address(text)
    except ValueError:
        if _NAME.fullmatch(text):
            return text
        sentence = f'{origin}: address is "{text}"; it must be an IP address or the name of a host, for example "10.0.0.2".'
        raise ScenarioError(sentence) from None
    if parsed.is_unspecified:
        raise ScenarioError(f'{origin}: address is "{text}"; the others must reach it: give the address of one interface.')
    return f"[{parsed}]" if parsed.version == 6 else str(parsed)


def _through(text: str, origin: str) -> tuple[str, ...]:
    try:
        words = tuple(shlex.split(text))
    except ValueError as error:
        reason = str(error).lower()
        raise ScenarioError(f"{origin}: through is {text!r}, {reason}; write it as on a command line.") from None
    if words and shutil.which(words[0]) is None:
        sentence = f'{origin}: through is "{text}"; there is no command {words[0]} here: install it, or name another.'
        raise ScenarioError(sentence)
    return words


def _said(name: str) -> str:
    return name.replace("/", " ")
