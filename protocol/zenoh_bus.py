"""The bus over Zenoh: members are processes (or objects of one), links are sockets; a `protocol.bus.Bus`.

Rules: the only module that imports zenoh. One session per member. Callbacks run in Zenoh's own threads and only
deposit; frames are opened in the member's thread by `receive`. No queue of ours ever makes a receiving thread wait.
Nothing that a peer does raises here; nothing waits without a way out.

Liveliness: a member announces itself when it first listens or looks around (`receive`, `ask`, `links`, `matched`), that
is after its subscriptions; its neighbours learn of the subscriptions first. A crash is seen when the socket closes, a
hang when a link was silent for the lease.

What is listened to begins with a wildcard, "*/{run}/...", though it is always "odour/{run}/...". For keys without one at
the start two Zenoh sessions agree on numbers, per link, and send these. A process that comes back over a new link, before
its peer has done with the old one, may be taken for the same link (eclipse-zenoh/zenoh issues 1886 and 2806); then the
peer goes on sending the old numbers, which mean other keys now, and messages arrive under wrong keys. Keys that begin
with a wildcard have no number: what is said under them is sent with its key in full, and cannot be taken for another.
"""

from __future__ import annotations

import json
import logging
import os
import re
import time
from collections.abc import Callable, Sequence
from threading import Thread
from typing import Any

import zenoh
from zenoh.handlers import Callback

from protocol.bus import Asked, BusEvent, Counters, Delivery, Publish
from protocol.codec import Codec, Refusal
from protocol.errors import SwarmFailure
from protocol.inbox import BIG_FRAME, Inbox
from protocol.keys import ROOT
from protocol.linger import let_go, over_tcp
from protocol.messages import Message
from protocol.roll import Roll
from protocol.thread_state import keep_thread_state
from protocol.zenoh_config import RUNTIME, check_names, member_of, session_id, session_settings, token_of

__all__ = ["ZenohBus", "token_of"]

CLOSE_WITHIN = 2.0  # s
_ALIVE = "alive/"
_AGAIN = 0.05  # s between two questions while nobody is there to answer
_MAX_WARNINGS = 100
_REMOTE = zenoh.Locality.REMOTE
_END = object()  # no more replies
_log = logging.getLogger(__name__)
os.environ.setdefault("ZENOH_RUNTIME", RUNTIME)  # read when the first session opens


class ZenohBus:
    """One member's access to a run over Zenoh.

    Args:
        run, token: name and number of the run (`token_of`); frames of other runs are refused.
        name: "world", "robot/3", ...; at most 12 ASCII characters.
        listen, connect: endpoints, "unixsock-stream/PATH" or "tcp/HOST:PORT"; whoever listens may come later.
        lease_ms: a link that was silent for so long is dead.
        lockstep: at most a few small messages to a peer are ever under way, as in lock-step. Links between members
            that both say so are faster, and a sender would hang with a peer that hangs if it were not true.

    Raises:
        ScenarioError: a name does not fit.
        SwarmFailure: an endpoint cannot be used.
    """

    def __init__(
        self,
        run: str,
        name: str,
        token: int,
        *,
        listen: Sequence[str],
        connect: Sequence[str],
        lease_ms: int = 400,
        lockstep: bool = False,
    ) -> None:
        check_names(run, name)
        _start_log()
        self.name = name
        self.counters = Counters()
        self._run, self._token = run, token
        self._codec = Codec(token)
        self._inbox = Inbox(self.counters)
        self._roll = Roll(self._inbox.push)
        self._prefix = f"{ROOT}/{run}/"
        self._heard = f"*/{run}/"  # the same for what is listened to
        self._publishers: dict[str, Any] = {}
        self._declared: list[Any] = []  # kept, or Zenoh would undeclare them
        self._names: dict[str, str] = {}  # session id -> member
        self._announced = False
        self._closed = False
        self._warned: set[str] = set()
        self._over_tcp = over_tcp((*listen, *connect))
        identity = session_id(run, token, name)
        self._session = _open(session_settings(identity, listen, connect, lease_ms, lockstep=lockstep), name)
        self._info = self._session.info
        self._watch_liveliness()

    def publisher(self, key: str, *, reliable: bool) -> Publish:
        control = zenoh.CongestionControl.BLOCK if reliable else zenoh.CongestionControl.DROP
        publisher = self._session.declare_publisher(
            self._prefix + key, congestion_control=control, express=True, allowed_destination=_REMOTE
        )
        self._publishers[key] = publisher
        put, encode, counters = publisher.put, self._codec.encode, self.counters

        def publish(message: Message) -> None:
            counters.sent += 1
            try:
                put(encode(message))
            except zenoh.ZError as error:
                self._complain(key, f"cannot be sent: {error}")

        return publish

    def subscribe(self, key: str, *kinds: type[Message]) -> None:
        offer, cut = self._inbox.offer, len(self._prefix)
        whole = None if "*" in key else key
        accepted = frozenset(kinds)

        def on_sample(sample: Any) -> None:
            keep_thread_state()
            frame = sample.payload.to_bytes()
            offer((whole or str(sample.key_expr)[cut:], accepted, frame, None), frame)

        handler = Callback(on_sample, indirect=False)
        declare = self._session.declare_subscriber
        self._declared.append(declare(self._heard + key, handler, allowed_origin=_REMOTE))
        if whole is not None:  # Zenoh looks up once who listens to it, not with every message; nobody else is told
            self._declared.append(self._session.declare_keyexpr(self._prefix + key))

    def serve(self, key: str, kind: type[Message]) -> None:
        offer, cut = self._inbox.offer, len(self._prefix)
        accepted = frozenset((kind,))

        def on_query(query: Any) -> None:
            keep_thread_state()
            payload = query.payload
            frame = b"" if payload is None else payload.to_bytes()
            if not offer((str(query.key_expr)[cut:], accepted, frame, query), frame):
                query.drop()

        handler = Callback(on_query, indirect=False)
        declare = self._session.declare_queryable
        self._declared.append(declare(self._heard + key, handler, complete=True, allowed_origin=_REMOTE))

    def ask(self, key: str, question: Message, timeout: float) -> Message | None:
        """First reply to a query, or None when nobody answered within `timeout` seconds.

        While nobody answers, or who was asked is gone, the question is repeated: whoever serves it must be able to
        answer it twice.
        """
        self._announce()
        deadline = time.monotonic() + timeout
        frame = self._codec.encode(question)
        while (left := deadline - time.monotonic()) > 0 and not self._closed:
            reply = self._ask_once(key, frame, left)
            if reply is not None:
                return reply
            time.sleep(max(0.0, min(_AGAIN, deadline - time.monotonic())))
        return None

    def receive(self, timeout: float | None) -> BusEvent | None:
        if not self._announced:
            self._announce()
        if self._closed:
            timeout = 0
        deadline = time.monotonic() + timeout if timeout else 0.0
        take = self._inbox.take
        while (entry := take(timeout)) is not None:
            if entry.__class__ is not tuple:
                return entry  # type: ignore[no-any-return]  # Seen, Lost
            event = self._opened(*entry)
            if event is not None:
                return event
            if timeout:  # a refused frame is no event: wait on for what is left
                timeout = max(0.0, deadline - time.monotonic())
        return None

    def links(self) -> frozenset[str]:
        """Members that this one is physically linked to now; a peer that is not of this run is "stranger/{id}"."""
        if not self._announced:
            self._announce()
        return frozenset(self._name_of(str(zid)) for zid in self._info.peers_zid())

    def matched(self, key: str, names: Sequence[str]) -> bool:
        """Whether the publication `key` has a subscriber and all of `names` are alive.

        Zenoh tells only whether there is any subscriber. But members announce themselves after their subscriptions,
        and in this order both travel over a link: of a member that is alive here the subscriptions are known here.
        """
        if not self._announced:
            self._announce()
        if self._closed:
            return False
        return bool(self._publishers[key].matching_status.matching) and self._roll.has(names)

    def close(self) -> None:
        if self._closed:
            return
        self._closed = True
        # Closing tells the peers, also one that hangs and takes nothing; whoever leaves does not wait for it.
        closing = Thread(target=self._session.close, daemon=True, name="closing")
        closing.start()
        closing.join(CLOSE_WITHIN)
        self._inbox.push(None)  # a `receive` that still waits returns

    def _announce(self) -> None:
        if not self._announced and not self._closed:
            self._announced = True
            try:
                token = self._session.liveliness().declare_token(self._prefix + _ALIVE + self.name)
                self._declared.append(token)
            except zenoh.ZError as error:  # closed by another thread in between
                self._complain(_ALIVE, f"cannot be announced: {error}")

    def _watch_liveliness(self) -> None:
        note, cut, me, tcp = self._roll.note, len(self._prefix + _ALIVE), self.name, self._over_tcp

        def on_token(sample: Any) -> None:
            keep_thread_state()
            name = str(sample.key_expr)[cut:]
            if tcp and sample.kind == zenoh.SampleKind.PUT:  # a link is new
                let_go()
            if name != me:
                note(name, sample.kind == zenoh.SampleKind.PUT)

        handler = Callback(on_token, indirect=False)
        declare = self._session.liveliness().declare_subscriber
        self._declared.append(declare(f"{self._heard}{_ALIVE}**", handler, history=True))

    def _opened(self, key: str, kinds: frozenset[type[Message]], frame: bytes, query: Any) -> BusEvent | None:
        """What a frame that arrived says; None when it is refused."""
        if len(frame) > BIG_FRAME:
            self._inbox.release(frame)
        message = self._codec.decode(frame)
        if message.__class__ in kinds:
            self.counters.received += 1
            return Delivery(key, message) if query is None else Asked(key, message, self._answer(query, key))
        self.counters.refused += 1
        reason = message.reason if isinstance(message, Refusal) else f"{type(message).__name__} is not said here"
        self._complain(key, f"refused: {reason}")
        if query is not None:
            query.drop()
        return None

    def _answer(self, query: Any, key: str) -> Callable[[Message], None]:
        left = [query]

        def answer(message: Message) -> None:
            if left:
                asked = left.pop()
                self.counters.sent += 1
                try:
                    asked.reply(self._prefix + key, self._codec.encode(message), express=True)
                except zenoh.ZError as error:
                    self._complain(key, f"cannot be answered: {error}")
                finally:
                    asked.drop()  # the asker need not wait for more

        return answer

    def _ask_once(self, key: str, frame: bytes, timeout: float) -> Message | None:
        replies = Inbox(self.counters)

        def on_reply(reply: Any) -> None:
            keep_thread_state()
            if reply.ok is not None:
                payload = reply.ok.payload.to_bytes()
                replies.offer(payload, payload)

        self.counters.sent += 1
        try:
            self._session.get(
                self._prefix + key,
                Callback(on_reply, drop=lambda: replies.push(_END), indirect=False),
                payload=frame,
                timeout=timeout,
                target=zenoh.QueryTarget.ALL,
                consolidation=zenoh.ConsolidationMode.NONE,
                allowed_destination=_REMOTE,
                express=True,
            )
        except zenoh.ZError as error:
            self._complain(key, f"cannot be asked: {error}")
            return None
        deadline = time.monotonic() + timeout
        while (answer := replies.take(max(0.0, deadline - time.monotonic()))) not in {None, _END}:
            message = self._codec.decode(answer)
            if not isinstance(message, Refusal):
                self.counters.received += 1
                return message
            self.counters.refused += 1
            self._complain(key, f"reply refused: {message.reason}")
        return None

    def _name_of(self, identity: str) -> str:
        name = self._names.get(identity)
        if name is None:
            name = self._names[identity] = member_of(self._run, self._token, identity)
        return name

    def _complain(self, key: str, text: str) -> None:
        """Log once per key; after `close` nothing is a surprise."""
        if not self._closed and key not in self._warned and len(self._warned) < _MAX_WARNINGS:
            self._warned.add(key)
            _log.warning("%s: %s %s", self.name, key, text)


def _open(settings: dict[str, object], name: str) -> Any:
    """A session with `settings`."""
    config = zenoh.Config()
    try:
        for path, value in settings.items():
            config.insert_json5(path, json.dumps(value))
        return zenoh.open(config)
    except zenoh.ZError as error:
        listen = ", ".join(settings["listen/endpoints"])  # type: ignore[arg-type]
        place = f"cannot listen at {listen}" if listen else "cannot join the run"
        reason = re.sub(r" at \S+\.rs:\d+\.?", "", str(error)).strip(" .")  # without the places in Zenoh's source
        raise SwarmFailure(
            f"{name} {place}: {reason}; end the process that uses the endpoint, or choose others with "
            f"network.transport, network.port or network.endpoints."
        ) from error


def _start_log() -> None:
    """Let Zenoh speak (on standard output) only if the person asked for it; by itself it says nothing."""
    level = os.environ.get("ODOURSWARM_LOG")
    if level:
        zenoh.init_log_from_env_or(level)
