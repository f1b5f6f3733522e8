"""Endpoints and names: what fits, what does not, and what is said then."""

import socket
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.endpoints import default_transport, free_tcp_endpoints, make_endpoints, tcp_endpoints, unix_endpoint
from protocol.errors import ScenarioError
from protocol.scenario import Scenario
from protocol.scenario.load import load_scenario
from protocol.zenoh_config import STRANGER, check_names, member_of, session_id, session_settings, token_of

NAMES = st.from_regex(r"[a-z][a-z0-9]{0,4}(/[0-9]{1,6})?", fullmatch=True)


def scenario(**network: object) -> Scenario:
    return load_scenario(None, overrides=[(f"network.{name}", value, "test") for name, value in network.items()])


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no unix sockets here")
def test_members_on_one_machine_speak_over_unix_sockets_in_the_runs_own_directory(tmp_path: Path) -> None:
    assert default_transport() == "unix"
    ends = make_endpoints(scenario(), Path("/tmp/run"))
    assert ends[:2] == ("unixsock-stream//tmp/run/world.sock", "unixsock-stream//tmp/run/robot-0.sock")
    assert len(set(ends)) == scenario().robots + 1


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no unix sockets here")
def test_a_socket_path_that_is_too_long_is_refused_with_advice() -> None:
    assert unix_endpoint(Path("/tmp/" + "d" * 80), "world").endswith("/world.sock")
    with pytest.raises(ScenarioError, match=r"TMPDIR.*network\.transport"):
        unix_endpoint(Path("/tmp/" + "ü" * 50), "world")


def test_free_ports_are_free_and_different() -> None:
    ends = free_tcp_endpoints(20)
    ports = [int(end.rsplit(":", 1)[1]) for end in ends]
    assert len(set(ports)) == 20
    for port in ports:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", port))


def test_given_ports_are_counted_from_the_first() -> None:
    ends = make_endpoints(scenario(transport="tcp", port=7447), Path("/unused"))
    assert ends[:2] == ("tcp/127.0.0.1:7447", "tcp/127.0.0.1:7448")
    assert all(end.startswith("tcp/") for end in make_endpoints(scenario(transport="tcp"), Path("/unused")))


@pytest.mark.parametrize("first", [0, -1, 65530])
def test_ports_that_do_not_exist_are_refused(first: int) -> None:
    assert tcp_endpoints(65526, 10)[-1] == "tcp/127.0.0.1:65535"
    with pytest.raises(ScenarioError, match=r"network\.port"):
        tcp_endpoints(first, 10)


@given(NAMES)
def test_a_session_id_tells_the_member_to_its_own_run_and_to_no_other(name: str) -> None:
    check_names("run-1", name)
    token = token_of("run-1")
    identity = session_id("run-1", token, name)
    assert len(identity) == 32
    assert identity[0] != "0"  # Zenoh takes no leading zeros
    assert member_of("run-1", token, identity) == name
    for run, other in (("run-2", token), ("run-1", token + 1)):
        assert member_of(run, other, identity) == STRANGER + identity


@given(st.one_of(st.text(max_size=40), st.integers(1, 2**128 - 1).map(lambda n: f"{n:x}")))
def test_an_id_that_we_did_not_make_is_a_strangers(identity: str) -> None:
    assert member_of("run", 1, identity) == STRANGER + identity


@pytest.mark.parametrize("name", ["", "robot/1234567", "räuber", "a\0b", "robot/*", "Robot/1", "a/b"])
def test_a_name_that_does_not_fit_is_refused(name: str) -> None:
    with pytest.raises(ScenarioError, match="member"):
        check_names("run", name)


@pytest.mark.parametrize("run", ["", "a/b", "a*", "-a", "a" * 65, "ü"])
def test_a_run_name_that_is_no_key_is_refused(run: str) -> None:
    check_names("run-1.a_B", "world")
    with pytest.raises(ScenarioError, match="run's name"):
        check_names(run, "world")


def test_a_member_links_to_declared_endpoints_only() -> None:
    settings = session_settings("ab", ["tcp/a:1"], ["tcp/b:2"], 400, lockstep=False)
    assert settings["scouting/multicast/enabled"] is settings["scouting/gossip/enabled"] is False
    assert settings["connect/endpoints"] == ["tcp/b:2"]
    assert settings["mode"] == "peer"
