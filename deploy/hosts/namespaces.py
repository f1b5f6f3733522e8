"""Hosts on one Linux machine: a network namespace for the world and for each robot, all at one switch.

    python -m deploy.hosts.namespaces lab --robots 5 -- odourswarm run --hosts lab.toml

makes the namespaces lab-world, lab-robot-0, ..., and lab-hub with the switch; writes lab.toml, which says who lives where;
runs the command inside lab-hub (none: a shell); and takes everything away when the command has ended. Each namespace
has one interface, eth0, whose cable leads to the switch. While it is there, from any terminal:

    ip -n lab-robot-2 link set eth0 down          robot 2 is cut off; "up": it is back
    ip netns exec lab-robot-2 iptables -A INPUT -s 10.0.0.0/24 -p tcp -m statistic --mode random --probability 0.25 -j DROP

Rules: everything is inside namespaces of its own name, none of it in the machine's own network. Whatever still runs there
at the end is ended. A kill -9 of this process leaves the namespaces; `--remove` takes them away. Root only.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from protocol import keys
from protocol.errors import ScenarioError, SwarmFailure
from protocol.shell import EXIT_BAD_INPUT, EXIT_FAILED, Stop, ignore_signals, stop_on_signals

HUB = "hub"  # the namespace of the switch and of the launcher
MOST_ROBOTS = 250
ROBOTS = "10.0.0.0/24"  # robot i is 10.0.0.(i + 1)
PREFIX = 23  # of all addresses: the robots' network and the one of hub and world
NAMED = Path("/run/netns")  # where `ip netns` keeps the names
IP_TIMEOUT = 20.0  # s for one `ip`
LEAVE = 3.0  # s that whoever is left in a namespace may take to leave before it is killed
POLL = 0.02  # s
MADE_BY = "# Network namespaces of one machine, made by `python -m deploy.hosts.namespaces {}`."
_NAME = re.compile(r"[a-z][a-z0-9-]{0,31}")


@dataclass(frozen=True, slots=True)
class Network:
    """The namespaces of one name."""

    name: str
    robots: int

    def namespace(self, member: str) -> str:
        """The namespace of "world", "robot/3" or "hub"."""
        return f"{self.name}-{member.replace('/', '-')}"

    @property
    def members(self) -> tuple[str, ...]:
        """World and robots."""
        return (keys.WORLD, *map(keys.robot_name, range(self.robots)))

    def address(self, member: str) -> str:
        """Its address at the switch."""
        robot = keys.robot_of(member)
        if robot is not None:
            return f"10.0.0.{robot + 1}"
        return "10.0.1.1" if member == HUB else "10.0.1.2"

    def within(self, member: str) -> list[str]:
        """What a command begins with to be run in its namespace."""
        return ["ip", "netns", "exec", self.namespace(member)]

    def make(self) -> None:
        """Make it all.

        Raises: SwarmFailure when that is not possible here; `remove` takes away what there is by then.
        """
        hub, members = self.namespace(HUB), self.members
        spaces = [self.namespace(member) for member in (HUB, *members)]
        _ip_batch([f"netns add {space}" for space in spaces])
        switch = ["link add switch type bridge", f"address add {self.address(HUB)}/{PREFIX} dev switch"]
        for n, member in enumerate(members):
            switch.append(f"link add cable{n} type veth peer name eth0 netns {self.namespace(member)}")
            switch.append(f"link set cable{n} master switch up")
        _ip_batch([*switch, "link set lo up", "link set switch up"], inside=hub)
        for member in members:
            cable = [f"address add {self.address(member)}/{PREFIX} dev eth0", "link set lo up", "link set eth0 up"]
            _ip_batch(cable, inside=self.namespace(member))

    def hosts(self) -> str:
        """The file for `odourswarm run --hosts`."""
        text = MADE_BY.format(self.name) + "\n"
        for member in self.members:
            robot = keys.robot_of(member)
            who = "world = true" if robot is None else f"robots = [{robot}]"
            through = " ".join(self.within(member))
            text += f'\n[[hosts]]\naddress = "{self.address(member)}"\nthrough = "{through}"\n{who}\n'
        return text


def left_over(name: str) -> list[str]:
    """The namespaces of network `name` that there are."""
    of_name = re.compile(re.escape(name) + rf"-({HUB}|{keys.WORLD}|robot-[0-9]+)")
    return sorted(path.name for path in NAMED.glob(f"{name}-*") if of_name.fullmatch(path.name))


def remove(name: str) -> None:
    """Take the namespaces of network `name` away; whoever still runs in them is ended first, politely, then not."""
    spaces = left_over(name)
    for number in (signal.SIGTERM, signal.SIGKILL):
        living = _inhabitants(spaces)
        for pid in living:
            with suppress(ProcessLookupError):
                os.kill(pid, number)
        deadline = time.monotonic() + LEAVE
        while living and time.monotonic() < deadline:
            time.sleep(POLL)
            living = _inhabitants(spaces)
    if spaces:
        _ip_batch([f"netns delete {space}" for space in spaces])


def _inhabitants(spaces: Sequence[str]) -> set[int]:
    """Processes in these namespaces, this one and those that have ended apart."""
    homes = set()
    for space in spaces:
        with suppress(FileNotFoundError):
            found = (NAMED / space).stat()
            homes.add((found.st_dev, found.st_ino))
    pids = set()
    for path in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # it has ended, in between too
            home = (path / "ns" / "net").stat()
            if (home.st_dev, home.st_ino) in homes:
                pids.add(int(path.name))
    return pids - {os.getpid()}


def _ip_batch(lines: Sequence[str], inside: str | None = None) -> None:
    command = ["ip", *(["-n", inside] if inside is not None else []), "-batch", "-"]
    text = "\n".join(lines) + "\n"
    try:
        done = subprocess.run(command, input=text, capture_output=True, text=True, check=False, timeout=IP_TIMEOUT)
    except FileNotFoundError:
        raise SwarmFailure("there is no command ip here; install iproute2.") from None
    except subprocess.TimeoutExpired:
        raise SwarmFailure(f"`{' '.join(command)}` did not end within {IP_TIMEOUT:g} s.") from None
    if done.returncode != 0:
        said = next((line for line in done.stderr.splitlines() if line.strip()), "it does not say why")
        raise SwarmFailure(f"network namespaces cannot be made or removed here: {said.strip()}; this needs Linux and root.")


def _live(network: Network, file: Path, command: Sequence[str]) -> int:
    """Make the network, run the command in its hub, remove the network; the command's exit status."""
    child: subprocess.Popen[bytes] | None = None
    try:
        network.make()
        started = file.with_name(file.name + ".new")
        started.write_text(network.hosts(), encoding="utf-8")
        started.replace(file)  # whole, when it is there: whoever waits for it can begin
        child = subprocess.Popen([*network.within(HUB), *command])
        while True:
            try:
                status = child.wait()
                return status if status >= 0 else 128 - status
            except KeyboardInterrupt:
                pass  # a Ctrl-C at the terminal has reached the command, too; it is the command's to end
    finally:
        ignore_signals()
        if child is not None and child.poll() is None:
            child.terminate()
        remove(network.name)
        if child is not None:
            child.wait()
        file.unlink(missing_ok=True)


def _checked(given: argparse.Namespace, command: Sequence[str]) -> tuple[Network, Path]:
    if not _NAME.fullmatch(given.name):
        raise ScenarioError(f'the name is "{given.name}"; it must be small letters, digits and "-", at most 32, like "lab".')
    if not 1 <= given.robots <= MOST_ROBOTS:
        raise ScenarioError(f"--robots is {given.robots}; it must be from 1 to {MOST_ROBOTS}.")
    if shutil.which(command[0]) is None:
        raise ScenarioError(f"there is no command {command[0]} here; give one that there is, or none for a shell.")
    file = given.hosts or Path(f"{given.name}.toml")
    if not given.remove and left_over(given.name):
        raise ScenarioError(f"network {given.name} is there already; choose another name, or give --remove first.")
    if not given.remove and file.exists():
        raise ScenarioError(f"{file} is there already; remove it, or choose another with --hosts.")
    return Network(given.name, given.robots), file


def main() -> int:
    """The command; its exit status is that of the command that it runs."""
    parser = argparse.ArgumentParser(
        prog="python -m deploy.hosts.namespaces",
        usage="%(prog)s NAME [--robots N] [--hosts FILE.toml] [-- COMMAND ...]",
        description="Run a command (none: a shell) amid hosts that are network namespaces.",
    )
    parser.add_argument("name", help="what the namespaces' names begin with")
    parser.add_argument("--robots", type=int, default=5, help="how many (5)")
    parser.add_argument("--hosts", type=Path, metavar="FILE.toml", help="the file that is written meanwhile (NAME.toml)")
    parser.add_argument("--remove", action="store_true", help="only remove what a run that was killed has left")
    cut = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    given, command = parser.parse_args(sys.argv[1:cut]), sys.argv[cut + 1 :] or [os.environ.get("SHELL", "/bin/sh")]
    try:
        network, file = _checked(given, command)
        if given.remove:
            remove(network.name)
            if file.is_file() and file.read_text(errors="replace").startswith(MADE_BY.format(network.name)):
                file.unlink()
            return 0
        stop_on_signals(leash=False)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        return _live(network, file, command)
    except ScenarioError as error:
        print(error, file=sys.stderr)
        return EXIT_BAD_INPUT
    except SwarmFailure as error:
        print(error, file=sys.stderr)
        return EXIT_FAILED
    except Stop:
        return 128 + signal.SIGTERM


if __name__ == "__main__":
    sys.exit(main())
