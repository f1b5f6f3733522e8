"""A member of a run in a process of its own, for tests: says back what it hears, one tick later.

    python zenoh_member.py RUN NAME LISTEN CONNECT...

It hears "robot/9/drive" and says "{NAME}/drive"; it is asked under "{NAME}/mute" and never answers.
"""

import sys

from protocol.bus import Delivery
from protocol.messages import Ask, Drive
from protocol.zenoh_bus import ZenohBus, token_of


def main(run: str, name: str, listen: str, *connect: str) -> None:
    bus = ZenohBus(run, name, token_of(run), listen=[listen], connect=connect)
    bus.subscribe("robot/9/drive", Drive)
    bus.serve(f"{name}/mute", Ask)
    say = bus.publisher(f"{name}/drive", reliable=True)
    while True:
        event = bus.receive(None)
        if isinstance(event, Delivery) and isinstance(event.message, Drive):
            say(Drive(event.message.robot, event.message.tick + 1, 0.0, 0.0))


if __name__ == "__main__":
    main(*sys.argv[1:])
