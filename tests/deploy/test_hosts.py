"""The file of hosts, and a swarm that is started through commands, as it would be on other hosts."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from swarm_helpers import near_the_plume

from deploy.hosts.namespaces import Network
from deploy.hosts.seats import read_seats
from deploy.memory_run import run_in_memory
from protocol.endpoints import free_tcp_endpoints
from protocol.errors import ScenarioError

DEADLINE = 90.0
NEAR = ["--set", "start.y=-6", "--set", "start.x=60", "--set", "plume.warm_up=120"]


def file_of(folder: Path, text: str) -> Path:
    file = folder / "hosts.toml"
    file.write_text(text, encoding="utf-8")
    return file


def one_host(folder: Path, through: str, robots: int = 3) -> Path:
    """Everybody on this machine, through a command."""
    port = free_tcp_endpoints(1)[0].rpartition(":")[2]
    head = f'port = {min(int(port), 65000)}\n[[hosts]]\naddress = "127.0.0.1"\nthrough = "{through}"\n'
    return file_of(folder, f"{head}world = true\nrobots = {list(range(robots))}\n")


def odourswarm(*flags: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "deploy.cli", "run", "--json", *flags]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=DEADLINE)


def test_members_of_a_host_listen_at_ports_in_a_row_and_keep_the_order_of_the_robots(tmp_path):
    text = """
        port = 7000
        python = "/opt/python"
        [[hosts]]
        address = "fd00::2"
        through = "env A='b c'"
        robots = [2, 0]
        [[hosts]]
        address = "10.0.0.1"
        python = "/usr/bin/python3"
        world = true
        robots = [1]
    """
    seats = read_seats(file_of(tmp_path, text), 3)
    assert seats.endpoints == ("tcp/10.0.0.1:7000", "tcp/[fd00::2]:7001", "tcp/10.0.0.1:7001", "tcp/[fd00::2]:7000")
    assert seats.members["robot/0"].through == ("env", "A=b c")
    assert seats.members["robot/0"].python == "/opt/python"
    assert seats.members["world"].through == ()
    assert seats.members["world"].python == "/usr/bin/python3"


def test_a_host_without_an_interpreter_of_its_own_takes_the_launchers(tmp_path):
    seats = read_seats(one_host(tmp_path, "env"), 3)
    assert {seat.python for seat in seats.members.values()} == {sys.executable}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('[[hosts]]\naddress="lab-1"\nworld=true\nrobots=[0]', ["robot 1 has no host"]),
        ('[[hosts]]\naddress="lab-1"\nrobots=[0, 1]', ["world has no host"]),
        ('[[hosts]]\naddress="lab-1"\nworld=true\nrobots=[0, 1, 2]', ["robot 2 is not of this run", "0 to 1"]),
        ('[[hosts]]\naddress="lab-1"\nworld=true\nrobots=[0, 1, 0]', ["robot 0 has a host already"]),
        ('[[hosts]]\naddress="lab 1"\nworld=true\nrobots=[0, 1]', ["[[hosts]] 1", '"lab 1"', "IP address"]),
        ('[[hosts]]\naddress="0.0.0.0"\nworld=true\nrobots=[0, 1]', ["others must reach it"]),
        ('[[hosts]]\naddress="a"\nthrough="no-such-command b"\nworld=true\nrobots=[0, 1]', ["no command no-such-command"]),
        ('[[hosts]]\naddress="a"\nthrough="env \'b"\nworld=true\nrobots=[0, 1]', ["through", "as on a command line"]),
        ('[[hosts]]\nadress="a"', ["hosts[0]", "adress", "address, through, python, world and robots"]),
        ("port = 70000\nhosts = []", ["port", "65535"]),
        ('port = 65535\n[[hosts]]\naddress="a"\nworld=true\nrobots=[0, 1]', ["no port is left for robot 0"]),
        ("hosts", ["not valid TOML"]),
    ],
)
def test_a_bad_file_of_hosts_is_refused_in_a_sentence_that_names_it(tmp_path, text, words):
    file = file_of(tmp_path, text)
    with pytest.raises(ScenarioError) as refused:
        read_seats(file, 2)
    sentence = str(refused.value)
    assert sentence.startswith(str(file))
    assert all(word in sentence for word in words), sentence
    assert "\n" not in sentence


def test_the_namespaces_file_of_hosts_seats_everybody_at_an_address_of_its_own(tmp_path):
    network = Network("lab", 5)
    text = network.hosts().replace("ip netns exec", "env")  # there may be no `ip` where this runs
    endpoints = read_seats(file_of(tmp_path, text), 5).endpoints
    assert endpoints == tuple(f"tcp/{network.address(member)}:7447" for member in network.members)
    assert len(set(endpoints)) == 6


def test_flags_that_contradict_the_hosts_are_refused_in_a_sentence(tmp_path):
    file = one_host(tmp_path, "env")
    for flags, words in (
        (["--bus", "memory"], "--bus zenoh"),
        (["--set", 'network.endpoints=["tcp/10.0.0.1:1","tcp/10.0.0.1:2","tcp/10.0.0.1:3","tcp/10.0.0.1:4"]'], "leave one"),
        (["--checkpoint-every", "1"], "add --checkpoint DIR"),
        (["--robots", "4"], "robot 3 has no host"),
    ):
        done = odourswarm("--hosts", str(file), "--robots", "3", *flags)
        assert done.returncode == 2, done.stderr
        assert words in done.stderr
        assert done.stdout == ""


@pytest.mark.processes
def test_a_swarm_started_through_a_command_has_the_digest_of_memory_also_when_a_robot_crashes_and_comes_back(tmp_path):
    fault = {"kind": "crash", "robot": 1, "at": 1.0, "restart": 1.0}
    flags = ["--robots", "3", "--topology", "line", "--max-time", "4", *NEAR]
    planned = ["--set", 'faults=[{kind="crash", robot=1, at=1.0, restart=1.0}]']
    done = odourswarm("--hosts", str(one_host(tmp_path, "nice -n 1")), *flags, *planned)
    assert done.returncode == 0, done.stderr
    outcome = json.loads(done.stdout)
    alone = run_in_memory(near_the_plume(robots=3, topology="line", max_time=4.0, faults=[fault]))
    assert outcome["digest"] == alone.digest
    assert outcome["faults"] == list(alone.faults)


@pytest.mark.processes
def test_a_robot_beyond_the_launchers_reach_cannot_be_planned_to_crash(tmp_path):
    # `timeout` stays between launcher and robot, as `ssh` would.
    done = odourswarm(
        "--hosts", str(one_host(tmp_path, f"timeout {DEADLINE:g}")), "--robots", "3", "--topology", "line",
        "--max-time", "60", "--set", 'faults=[{kind="crash", robot=1, at=50.0}]', *NEAR,
    )  # fmt: skip
    assert done.returncode == 3
    assert "beyond the reach" in done.stderr
    assert "timeout" in done.stderr


@pytest.mark.processes
def test_a_command_that_does_not_reach_the_host_ends_the_run_with_its_own_words(tmp_path):
    through = "sh -c 'echo no route to lab-2 >&2; exit 7'"
    done = odourswarm("--hosts", str(one_host(tmp_path, through)), "--robots", "3", "--topology", "line", *NEAR)
    assert done.returncode == 3
    assert "no route to lab-2" in done.stderr


@pytest.mark.processes
def test_a_world_that_never_answers_is_not_waited_for(tmp_path):
    # The command to the hosts hangs: nothing ever listens there.
    through = "sh -c 'exec sleep 600'"
    done = odourswarm(
        "--hosts", str(one_host(tmp_path, through)), "--robots", "3", "--topology", "line",
        "--set", "network.join_timeout=1", *NEAR,
    )  # fmt: skip
    assert done.returncode == 3
    assert "no world answers at tcp/127.0.0.1" in done.stderr
