"""A member of a run in a process of its own, for tests: says its number under each of many keys, all the time.

    python zenoh_speaker.py RUN NAME LEASE_MS KEYS LISTEN
"""

import sys
from itertools import count

from protocol.messages import Drive
from protocol.zenoh_bus import ZenohBus, token_of


def main(run: str, name: str, lease_ms: str, keys: str, listen: str) -> None:
    bus = ZenohBus(run, name, token_of(run), listen=[listen], connect=[], lease_ms=int(lease_ms))
    say = [bus.publisher(f"robot/{k}/drive", reliable=k % 2 == 0) for k in range(int(keys))]
    for tick in count():
        for k, publish in enumerate(say):
            publish(Drive(k, tick, 0.0, 0.0))
        bus.receive(0.002)


if __name__ == "__main__":
    main(*sys.argv[1:])
