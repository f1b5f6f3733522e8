"""A socket whose cable is cut does not hold up whoever closes it."""

import socket
import struct
import sys
import time

import pytest

from protocol.endpoints import free_tcp_endpoints
from protocol.linger import let_go, lingering, over_tcp
from protocol.zenoh_bus import ZenohBus, token_of

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows lists no open files")
DEADLINE = 20.0


def test_only_sockets_of_the_network_are_looked_at():
    assert over_tcp(["unixsock-stream//tmp/a.sock", "tcp/10.0.0.1:7447"])
    assert over_tcp(["tls/lab-1:7447"])
    assert not over_tcp(["unixsock-stream//tmp/a.sock"])
    assert not over_tcp([])


def test_a_socket_that_lingers_does_so_no_more_and_stays_open():
    with socket.socket() as one, socket.socket() as other:
        one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 10))
        assert lingering() == [one.fileno()]
        let_go()
        assert lingering() == []
        one.bind(("127.0.0.1", 0))
        assert one.getsockname()[1] > 0
        assert other.fileno() >= 0


def test_no_link_of_a_member_lingers_once_the_other_is_seen():
    run, endpoint = "linger", free_tcp_endpoints(1)[0]
    a = ZenohBus(run, "robot/0", token_of(run), listen=(endpoint,), connect=())
    b = ZenohBus(run, "robot/1", token_of(run), listen=(), connect=(endpoint,))
    try:
        end = time.monotonic() + DEADLINE
        while not (a.links() and b.links() and a.receive(0.01) is None and b.receive(0.01) is None and not lingering()):
            assert time.monotonic() < end
    finally:
        a.close()
        b.close()
