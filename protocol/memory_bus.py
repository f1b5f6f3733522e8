"""The bus in memory: members of one process, no threads, no clock; the wires of tests and Monte-Carlo sweeps.

Rules: links are physical, as over Zenoh: what a member publishes reaches the members linked to it and nobody else.
Messages are handed on by reference; with `wire=True` every message goes through the codec, byte for byte as over Zenoh.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from fnmatch import fnmatchcase

from protocol.bus import Asked, BusEvent, Counters, Delivery, Lost, Publish, Seen
from protocol.codec import Codec, Refusal
from protocol.messages import Message


class MemoryNetwork:
    """The links of one run. `links` are undirected pairs of member names."""

    def __init__(self, links: Iterable[tuple[str, str]], *, token: int = 0, wire: bool = False) -> None:
        self.codec = Codec(token) if wire else None
        self.version = 0  # changes whenever the way of a message can change
        self._linked: dict[str, dict[str, None]] = {}
        self._members: dict[str, MemoryBus] = {}
        for a, b in links:
            self._linked.setdefault(a, {})[b] = None
            self._linked.setdefault(b, {})[a] = None

    def join(self, name: str) -> MemoryBus:
        """Bring member `name` to life."""
        bus = MemoryBus(self, name)
        for other in self.peers(name):
            self._members[other].inbox.append(Seen(name))
            bus.inbox.append(Seen(other))
        self._members[name] = bus
        self.version += 1
        return bus

    def kill(self, name: str) -> None:
        """End member `name` as SIGKILL would: its peers see it `Lost`, what it sent before stays sent."""
        if self._members.pop(name, None) is not None:
            self.version += 1
            for other in self.peers(name):
                self._members[other].inbox.append(Lost(name))

    def peers(self, name: str) -> tuple[str, ...]:
        """Living members that `name` is linked to, in the order of the declared links."""
        return tuple(other for other in self._linked.get(name, ()) if other in self._members)

    def is_alive(self, bus: MemoryBus) -> bool:
        """Whether `bus` is the living member of its name."""
        return self._members.get(bus.name) is bus

    def member(self, name: str) -> MemoryBus:
        """The living member `name`."""
        return self._members[name]

    def peers_of(self, bus: MemoryBus) -> list[MemoryBus]:
        """Living members that `bus` is linked to; none when it was killed, closed, or replaced by a later one."""
        if not self.is_alive(bus):
            return []
        return [self._members[other] for other in self.peers(bus.name)]

    def listeners(self, bus: MemoryBus, key: str) -> list[MemoryBus]:
        """Peers of `bus` that are subscribed to `key`."""
        return [other for other in self.peers_of(bus) if other.kinds_under(key)]

    def inject(self, name: str, key: str, frame: bytes) -> None:
        """Give member `name` raw bytes under `key`, as a stranger on the wires would."""
        self._members[name].take_frame(key, frame)


class MemoryBus:
    """One member's access to a `MemoryNetwork`; a `protocol.bus.Bus`."""

    def __init__(self, network: MemoryNetwork, name: str) -> None:
        self.name = name
        self.counters = Counters()
        self.inbox: deque[BusEvent] = deque()
        self._network = network
        self._subscriptions: dict[str, tuple[type[Message], ...]] = {}
        self._resolved: dict[str, tuple[type[Message], ...]] = {}
        self._served: dict[str, type[Message]] = {}

    def publisher(self, key: str, *, reliable: bool) -> Publish:
        network, counters = self._network, self.counters
        codec = network.codec
        route: list[MemoryBus] = []
        version = -1

        def publish(message: Message) -> None:
            nonlocal version
            if version != network.version:
                version = network.version
                route[:] = network.listeners(self, key)
            counters.sent += 1
            if codec is None:
                delivery = Delivery(key, message)
                for bus in route:
                    bus.take(delivery)
            elif route:
                frame = codec.encode(message)
                for bus in route:
                    bus.take_frame(key, frame)

        return publish

    def subscribe(self, key: str, *kinds: type[Message]) -> None:
        self._subscriptions[key] = kinds
        self._resolved.clear()
        self._network.version += 1

    def serve(self, key: str, kind: type[Message]) -> None:
        self._served[key] = kind

    def ask(self, key: str, question: Message, timeout: float) -> Message | None:
        """Put a query to the peers that serve `key`.

        None, as if nobody answered in time: in one thread nobody can answer while the asker waits. (No member of an
        in-memory run asks; there is nothing to join.)
        """
        for other in self._network.peers_of(self):
            other.be_asked(key, question)
        return None

    def be_asked(self, key: str, question: Message) -> None:
        """Queue a query that a peer asks; its answer comes too late for anybody."""
        for pattern, kind in self._served.items():
            if fnmatchcase(key, pattern) and isinstance(question, kind):
                self.inbox.append(Asked(key, question, lambda answer: None))

    def receive(self, timeout: float | None = 0) -> BusEvent | None:
        return self.inbox.popleft() if self.inbox else None

    def links(self) -> frozenset[str]:
        return frozenset(bus.name for bus in self._network.peers_of(self))

    def matched(self, key: str, names: Sequence[str]) -> bool:
        listeners = {bus.name for bus in self._network.listeners(self, key)}
        return bool(listeners) and listeners.issuperset(names)

    def close(self) -> None:
        if self._network.is_alive(self):
            self._network.kill(self.name)

    def take(self, delivery: Delivery) -> None:
        """Receive a message from a peer, or refuse it."""
        if delivery.message.__class__ in self.kinds_under(delivery.key):
            self.counters.received += 1
            self.inbox.append(delivery)
        else:
            self.counters.refused += 1

    def take_frame(self, key: str, frame: bytes) -> None:
        """Receive bytes from a peer or a stranger; only a network with `wire=True` carries bytes."""
        codec = self._network.codec
        if codec is None:
            raise ValueError("this MemoryNetwork carries messages, not bytes: make it with wire=True")
        message = codec.decode(frame)
        if isinstance(message, Refusal):
            self.counters.refused += 1
        else:
            self.take(Delivery(key, message))

    def kinds_under(self, key: str) -> tuple[type[Message], ...]:
        """The kinds of message that this member takes under `key`; empty: it is not subscribed."""
        kinds = self._resolved.get(key)
        if kinds is None:
            subscriptions = self._subscriptions.items()
            kinds = tuple(kind for pattern, ks in subscriptions if fnmatchcase(key, pattern) for kind in ks)
            self._resolved[key] = kinds
        return kinds
