"""What the launcher does to its robots when the world says that a planned fault is due.

Rules: really: a crash is SIGKILL, a hang SIGSTOP and SIGCONT, or what the platform has for these (psutil knows). A
process that has ended already is left alone. Nobody is left stopped.
"""

from __future__ import annotations

from contextlib import suppress

import psutil

from deploy.launch.children import Children
from protocol import keys
from protocol.errors import SwarmFailure
from protocol.messages import Inject
from protocol.scenario import Scenario
from protocol.scenario.faults import Crash, Hang


class Injector:
    """The faults of processes of one run."""

    def __init__(self, children: Children) -> None:
        self._children = children
        self.stopped: set[str] = set()  # members that it has stopped

    def refuse_beyond_reach(self, scenario: Scenario) -> None:
        """Refuse faults of processes that are not this machine's.

        To be called when all robots have joined: what a robot was started through has given way to it by then, as `ip
        netns exec` does, or never will, as `ssh`, whose end or halt is not that of the robot.

        Raises: SwarmFailure.
        """
        for robot in sorted({fault.robot for fault in scenario.faults if isinstance(fault, Crash | Hang)}):
            child = self._children.members[keys.robot_name(robot)]
            with suppress(psutil.NoSuchProcess):
                line = psutil.Process(child.process.pid).cmdline()
                if line and line[0] != child.python:
                    raise SwarmFailure(
                        f"robot {robot} is to crash or hang as the faults say, and its process is beyond the reach of this "
                        f"launcher, behind {line[0]}; leave the fault out, or seat the robot on this machine."
                    )

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
