"""Across hosts: each robot in a network namespace of its own, at an address of its own, over TCP; real links are cut.

Root only. Every network has a name of its own and lives as long as the pipe to the process that made it: whichever way a
test ends, nothing is left, and two runs of these tests do not meet.
"""

import json
import os
import secrets
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from itertools import pairwise
from pathlib import Path

import pytest
from swarm_helpers import near_the_plume

from deploy.checkers.check import check_run, read_folder
from deploy.checkers.history import History
from deploy.hosts.namespaces import HUB, ROBOTS, Network, left_over
from deploy.memory_run import run_in_memory
from protocol.history.file import records_in
from protocol.history.records import Moved

pytestmark = pytest.mark.processes
DEADLINE = 60.0
NEAR = ["--set", "start.y=-6", "--set", "start.x=60", "--set", "plume.warm_up=120"]
STILL = ["--set", "plume.release_rate=0", "--set", "plume.warm_up=0"]
REALTIME = ["--clock", "realtime", "--speed", "2", *STILL]


def why_not() -> str | None:
    """Why there can be no network namespaces here; None: there can."""
    if sys.platform != "linux":
        return "network namespaces are Linux's"
    if os.geteuid() != 0:
        return "network namespaces need root"
    if shutil.which("ip") is None:
        return "there is no command ip; install iproute2"
    space = f"odour-try-{secrets.token_hex(3)}"
    try:
        add = f"ip -n {space} link add name"
        for command in (f"ip netns add {space}", f"{add} s type bridge", f"{add} c type veth peer name d"):
            done = subprocess.run(command.split(), capture_output=True, text=True, check=False, timeout=DEADLINE)
            if done.returncode:
                return f"no network namespace with a switch can be made (CAP_NET_ADMIN?): {done.stderr.strip()}"
    finally:
        subprocess.run(["ip", "netns", "delete", space], capture_output=True, check=False, timeout=DEADLINE)
    return None


def wait_for(condition: Callable[[], bool], what: str) -> None:
    end = time.monotonic() + DEADLINE
    while not condition():
        assert time.monotonic() < end, f"not within {DEADLINE} s: {what}"
        time.sleep(0.01)


class Lab:
    """A network of this test's own, for as long as this process lives or until it is closed."""

    def __init__(self, folder: Path, robots: int) -> None:
        self.network = Network(f"odour-{secrets.token_hex(4)}", robots)
        self.hosts = folder / f"{self.network.name}.toml"
        command = [sys.executable, "-m", "deploy.hosts.namespaces", self.network.name, "--robots", str(robots)]
        # It lives as long as `cat`, which lives as long as the pipe.
        self.maker = subprocess.Popen([*command, "--hosts", str(self.hosts), "--", "cat"], stdin=subprocess.PIPE)
        self.runs: list[subprocess.Popen[str]] = []

    def ready(self) -> "Lab":
        wait_for(lambda: self.hosts.exists() or self.maker.poll() is not None, "the network is there")
        assert self.maker.poll() is None
        return self

    def start(self, *flags: str, said: Path | None = None) -> subprocess.Popen[str]:
        command = [sys.executable, "-m", "deploy.cli", "run", "--hosts", str(self.hosts), *flags]
        errors = subprocess.PIPE if said is None else said.open("w")
        run = subprocess.Popen([*self.network.within(HUB), *command], stdout=subprocess.PIPE, stderr=errors, text=True)
        self.runs.append(run)
        if said is not None:
            errors.close()
        return run

    def within(self, member: str, *command: str) -> str:
        whole = [*self.network.within(member), *command]
        return subprocess.run(whole, capture_output=True, text=True, check=True, timeout=DEADLINE).stdout

    def tcp(self, member: str) -> dict[str, int]:
        """Counters of the member's own TCP."""
        names, values = [line.split()[1:] for line in self.within(member, "cat", "/proc/net/snmp").splitlines()
                         if line.startswith("Tcp:")]  # fmt: skip
        return dict(zip(names, map(int, values), strict=True))

    def close(self) -> None:
        for run in self.runs:
            if run.poll() is None:
                run.terminate()
            with suppress(subprocess.TimeoutExpired):
                run.communicate(timeout=DEADLINE)
        self.maker.stdin.close()
        status = self.maker.wait(DEADLINE)
        assert status == 0
        assert left_over(self.network.name) == []
        assert not self.hosts.exists()


@pytest.fixture(scope="module", autouse=True)
def _possible() -> None:
    reason = why_not()
    if reason is not None:
        pytest.skip(reason)


@pytest.fixture
def lab(tmp_path) -> Iterator[Lab]:
    lab = Lab(tmp_path, 5)
    try:
        yield lab.ready()
    finally:
        lab.close()


def ticks_in(file: Path) -> int:
    """The newest tick that the world has written down."""
    if not file.exists():
        return -1
    return max((record.tick for record in records_in(file.read_bytes(), str(file)) if isinstance(record, Moved)), default=-1)


def uses(history: History, i: int, j: int) -> list[int]:
    """Ticks at which robot i used a state of robot j."""
    return [act.tick for life in history.lives[i] for act in life.acted if any(used[0] == j for used in act.used)]


def broken(history: History) -> list[str | None]:
    return [finding.counterexample for finding in check_run(history) if not finding.passed]


def test_five_robots_on_five_hosts_have_the_digest_of_one_process(lab):
    run = lab.start("--json", "--max-time", "3", *NEAR)
    out, err = run.communicate(timeout=DEADLINE)
    assert run.returncode == 0, err
    outcome = json.loads(out)
    alone = run_in_memory(near_the_plume(max_time=3.0))
    assert outcome["digest"] == alone.digest
    assert outcome["faults"] == []
    # It was said over these hosts' own TCP: at 60 ticks each tells its reading's answer and its state.
    assert all(lab.tcp(member)["OutSegs"] > 60 for member in lab.network.members)


def test_a_robot_whose_cable_is_out_for_a_while_stops_is_forgotten_and_comes_back(lab, tmp_path):
    said, folder = tmp_path / "said", tmp_path / "history"
    run = lab.start(*REALTIME, "--max-time", "15", "--set", "realtime.alone=20", "--history", str(folder), said=said)
    world = folder / "world.history"
    wait_for(lambda: ticks_in(world) >= 30 or run.poll() is not None, "the run is under way")
    cut = ("ip", "-n", lab.network.namespace("robot/2"), "link", "set", "eth0")
    subprocess.run([*cut, "down"], check=True, timeout=DEADLINE)
    cut_at, known = ticks_in(world), said.read_text().count("robot 2 lost")
    wait_for(lambda: said.read_text().count("robot 2 lost") > known or run.poll() is not None, "the world misses robot 2")
    lost_at, known = ticks_in(world), said.read_text().count("robot 2 is back")
    wait_for(lambda: ticks_in(world) >= lost_at + 60 or run.poll() is not None, "three seconds without robot 2")
    subprocess.run([*cut, "up"], check=True, timeout=DEADLINE)
    wait_for(lambda: said.read_text().count("robot 2 is back") > known or run.poll() is not None, "robot 2 is back")
    back_at = ticks_in(world)
    out, _ = run.communicate(timeout=DEADLINE)
    assert run.returncode == 0, said.read_text()
    assert "Ended after 15.0 s" in out

    history = read_folder(folder)
    assert broken(history) == []
    moved = {each.tick: each for each in history.moved}
    away = [k for k in range(cut_at, back_at) if 2 in moved[k].dead]
    # The safe stop: when its drives are too old its body brakes; once at rest it stays where it is.
    assert all(2 in moved[k].braked for k in away)
    stands = {moved[k].poses[2][:3] for k in away[20:]}
    assert len(stands) == 1
    assert moved[max(moved)].poses[2][:3] not in stands
    stale = round(history.scenario.timing.stale_after / history.dt)
    for i, j in ((1, 2), (3, 2), (2, 1), (2, 3)):
        # Each side of either edge drops the other within the bound, and hears it again when the cable is in.
        heard = uses(history, i, j)
        gap = max(pairwise(heard), key=lambda pair: pair[1] - pair[0])
        assert gap[0] <= cut_at + stale + 5, (i, j, gap)  # the tick of the cut is read from a file: some ticks of grace
        assert gap[1] >= lost_at + 60, (i, j, gap)
    acted = {i: sum(cut_at <= act.tick < back_at for life in history.lives[i] for act in life.acted) for i in range(5)}
    # Who had the cable's other end drives on; a socket that cannot be emptied holds up nobody.
    assert min(acted[1], acted[3]) > 0.5 * max(acted[0], acted[4])


def test_in_lock_step_the_others_go_on_without_a_robot_whose_cable_is_out(lab, tmp_path):
    said, folder = tmp_path / "said", tmp_path / "history"
    run = lab.start("--max-time", "2000", *STILL, "--history", str(folder), said=said)

    def sizes() -> list[int]:
        files = [folder / f"robot-{i}.history" for i in range(5)]
        return [file.stat().st_size if file.exists() else 0 for file in files]

    wait_for(lambda: min(sizes()) > 5000 or run.poll() is not None, "the run is under way")
    space = lab.network.namespace("robot/2")
    subprocess.run(["ip", "-n", space, "link", "set", "eth0", "down"], check=True, timeout=DEADLINE)
    wait_for(lambda: "robot 2 lost" in said.read_text() or run.poll() is not None, "robot 2 is missed")
    there = sizes()

    def others_went_on() -> bool:
        return run.poll() is not None or all(sizes()[i] > there[i] + 5000 for i in (0, 1, 3, 4))

    wait_for(others_went_on, "the others go on")
    assert run.poll() is None


def test_a_swarm_lives_with_a_quarter_of_its_packets_lost(lab, tmp_path):
    if shutil.which("iptables") is None:
        pytest.skip("there is no command iptables; install it")
    rule = ("iptables", "-w", "-A", "INPUT", "-s", ROBOTS, "-p", "tcp", "-m", "statistic", "--mode", "random")
    said, folder = tmp_path / "said", tmp_path / "history"
    # A link that was silent for the lease is ended; what TCP sends again after a loss takes 0.2 s, or twice that, or ...
    run = lab.start(*REALTIME, "--max-time", "10", "--set", "network.lease_ms=3000", "--history", str(folder), said=said)
    world = folder / "world.history"
    wait_for(lambda: ticks_in(world) >= 20 or run.poll() is not None, "the run is under way")
    robots = [member for member in lab.network.members if member != "world"]
    before = {member: lab.tcp(member)["RetransSegs"] for member in robots}
    for member in robots:
        lab.within(member, *rule, "--probability", "0.25", "-j", "DROP")
    lossy_from = ticks_in(world)
    out, _ = run.communicate(timeout=DEADLINE)
    assert run.returncode == 0, said.read_text()
    assert "Ended after 10.0 s" in out
    assert all(lab.tcp(member)["RetransSegs"] > before[member] + 5 for member in robots)
    history = read_folder(folder)
    assert broken(history) == []
    for i, j in [(k, (k + side) % 5) for k in range(5) for side in (1, 4)]:
        assert len([k for k in uses(history, i, j) if k > lossy_from]) > 10, (i, j)


OWNER = """
import subprocess, sys
from pathlib import Path
name, hosts = sys.argv[1:]
maker = [sys.executable, "-m", "deploy.hosts.namespaces", name, "--robots", "2", "--hosts", hosts, "--", "cat"]
subprocess.Popen(maker, stdin=subprocess.PIPE).wait()
"""


def test_who_is_killed_leaves_no_namespace_and_takes_nothing_of_another(tmp_path):
    name, hosts = f"odour-{secrets.token_hex(4)}", tmp_path / "killed.toml"
    other = Lab(tmp_path, 2)
    owner = subprocess.Popen([sys.executable, "-c", OWNER, name, str(hosts)])
    sleeper = None
    try:
        wait_for(lambda: hosts.exists() or owner.poll() is not None, "the network is there")
        other.ready()
        sleeper = subprocess.Popen([*Network(name, 2).within("robot/1"), "sleep", "600"])
        wait_for(lambda: "sleep" in Path(f"/proc/{sleeper.pid}/comm").read_text(), "somebody lives there")
        owner.send_signal(signal.SIGKILL)
        assert sleeper.wait(DEADLINE) == -signal.SIGTERM  # whoever lives there is ended
        wait_for(lambda: left_over(name) == [], "the namespaces of the killed one are gone")
        wait_for(lambda: not hosts.exists(), "its file is gone")
        assert len(left_over(other.network.name)) == 4
        assert other.within("robot/0", "cat", "/proc/net/dev").count("eth0") == 1
    finally:
        owner.kill()
        owner.wait()
        if sleeper is not None:
            sleeper.kill()
        other.close()
