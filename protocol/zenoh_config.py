"""How a member's Zenoh session is set up, and the name that is written into its id.

Rules: pure data, no zenoh here. The graph is physical: peers, one listen endpoint, connect endpoints for the declared
links only, neither gossip nor multicast scouting, so that nobody is linked to anybody who was not declared. A session's
id is a function of run, token and name: a restarted member is the same peer again, and while one lives its neighbours
refuse a second one of the same name.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from hashlib import blake2b

from protocol.codec import MAX_FRAME
from protocol.errors import ScenarioError
from protocol.keys import RUN_NAME

# Sockets wake the runtime that opened them; when another one reads them, every message costs a further change of
# threads. So those that open, accept and read share one thread. Sending keeps its own: a receiving thread that waits
# for the interpreter, or for room to send, must not silence us towards our neighbours.
RUNTIME = "(rx: (worker_threads: 1), net: (handover: rx), acc: (handover: rx))"

NAME_BYTES = 12  # of the 16 bytes of a session id; the rest tells the run
_MEMBER = re.compile(r"[a-z][a-z0-9]*(/[0-9]+)?")
STRANGER = "stranger/"  # before the id of a peer that is not of this run


def token_of(run: str) -> int:
    """The number that a run's frames and session ids are salted with, 64 bits."""
    return int.from_bytes(blake2b(run.encode(), digest_size=8, person=b"odour-run").digest(), "little")


def check_names(run: str, name: str) -> None:
    """Refuse a run or member name that does not fit into keys and ids.

    Raises:
        ScenarioError: one of them does not.
    """
    if not RUN_NAME.fullmatch(run):
        raise ScenarioError(
            f"the run's name is {run!r}; it must have 1 to 64 letters, digits, '.', '-' or '_', the first one a letter "
            f"or a digit."
        )
    if len(name) > NAME_BYTES or not _MEMBER.fullmatch(name):
        raise ScenarioError(
            f'a member\'s name is {name!r}; it must be like "world" or "robot/12": small letters and digits, at most '
            f"{NAME_BYTES} characters."
        )


def session_id(run: str, token: int, name: str) -> str:
    """The session id (hexadecimal) of member `name`: the name itself and a mark of the run."""
    return name.encode("ascii").ljust(NAME_BYTES, b"\0").hex() + _mark(run, token, name)


def member_of(run: str, token: int, identity: str) -> str:
    """Member whose session id is `identity`; an id that is not of this run gives "stranger/...". """
    try:
        name = bytes.fromhex(identity[: 2 * NAME_BYTES]).rstrip(b"\0").decode("ascii")
    except ValueError:
        return STRANGER + identity
    if name and identity == session_id(run, token, name):
        return name
    return STRANGER + identity


def session_settings(
    identity: str, listen: Sequence[str], connect: Sequence[str], lease_ms: int, *, lockstep: bool
) -> dict[str, object]:
    """Zenoh's configuration, path by path.

    `lockstep`: a link between two members that both want it is written by the thread that sends, which saves a change
    of threads per message. It knows no congestion: to a peer that hangs one may only send what its socket holds (some
    200 small frames), until the lease has ended the link. A frame that is larger than a batch is not sent over it.
    """
    # A peer that is not up yet is tried again in the background, soon and for ever.
    retry = {"period_init_ms": 20, "period_max_ms": 200, "period_increase_factor": 1.5}
    return {
        "id": identity,
        "mode": "peer",
        "listen/endpoints": list(listen),
        "listen/exit_on_failure": True,
        "listen/timeout_ms": 0,
        "connect/endpoints": list(connect),
        "connect/exit_on_failure": False,
        "connect/timeout_ms": -1,
        "connect/retry": retry,
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        # Do not hold up the start for neighbours: whoever needs a link looks at `links`.
        "open/return_conditions": {"connect_scouted": False, "declares": False},
        "adminspace/enabled": False,
        "timestamping/enabled": False,
        "transport/shared_memory/enabled": False,
        "transport/link/tx/lease": lease_ms,
        "transport/link/rx/max_message_size": MAX_FRAME + 4096,
        # Room for the largest frame, so that sending one does not wait for the link; taken only when it is needed.
        "transport/link/tx/queue/size/data": 16,
        # A reliable sender waits no longer for a peer that takes nothing than a silent link lives.
        "transport/link/tx/queue/congestion_control/block/wait_before_close": 1000 * lease_ms,  # microseconds
        "transport/link/tx/queue/congestion_control/drop/wait_before_drop": 1000,
        "transport/link/tx/queue/congestion_control/drop/max_wait_before_drop_fragments": 5000,
        "transport/unicast/qos/enabled": False,
        "transport/unicast/lowlatency": lockstep,
    }


def _mark(run: str, token: int, name: str) -> str:
    text = f"{run}\0{name}".encode()
    return blake2b(text, digest_size=4, key=token.to_bytes(8, "little")).hexdigest()
