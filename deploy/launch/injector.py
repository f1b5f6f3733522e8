"""What the launcher does to its robots when the world says that a planned fault is due.

Rules: really: a crash is SIGKILL, a hang SIGSTOP and SIGCONT, or what the platform has for these (psutil knows). A
process that has ended already is left alone. Nobody is left stopped.
"""

from __future__ import annotations

from contextlib import suppress

import psutil

from deploy.launch.children import Children
from protocol import keys
from protocol.messages import Inject


class Injector:
    """The faults of processes of one run."""

    def __init__(self, children: Children) -> None:
        self._children = children
        self.stopped: set[str] = set()  # members that it has stopped

    def do(self, order: Inject) -> None:
        """Stop, continue or kill a robot's process."""
        name = keys.robot_name(order.robot)
        child = self._children.members.get(name)
        if child is None or child.status is not None:
            return
        with suppress(psutil.NoSuchProcess):
            process = psutil.Process(child.process.pid)
            if order.action == "stop":
                process.suspend()
                self.stopped.add(name)
            elif order.action == "continue":
                process.resume()
                self.stopped.discard(name)
            elif order.action == "kill":
                process.kill()
                self.stopped.discard(name)

    def end(self) -> None:
        """The run is over: a process that hangs to the end cannot leave by itself."""
        for name in self.stopped:
            child = self._children.members[name]
            if child.status is None:
                child.process.kill()
        self.stopped.clear()
