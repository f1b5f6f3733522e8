"""Wheels that are weak: they give a part of the torque that the motor would give."""

from __future__ import annotations

from protocol.motors import limited
from protocol.scenario import Scenario
from protocol.scenario.faults import Actuator


class ActuatorFaults:
    """All of a run."""

    def __init__(self, scenario: Scenario) -> None:
        self._body = scenario.body
        dt = scenario.timing.tick
        self._faults = [(*fault.ticks(dt), fault) for fault in scenario.faults if isinstance(fault, Actuator)]

    def weaken(self, tick: int, left: list[float], right: list[float]) -> None:
        """Change the torques of tick `tick` in place."""
        for first, end, fault in self._faults:
            if first <= tick < end:
                i = fault.robot
                left[i], right[i] = limited(left[i], right[i], self._body)
                if fault.wheel != "right":
                    left[i] *= fault.strength
                if fault.wheel != "left":
                    right[i] *= fault.strength
