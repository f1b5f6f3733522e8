"""What a robot says and hears on a bus, whichever bus it is."""

from __future__ import annotations

from dataclasses import dataclass

from protocol import keys
from protocol.bus import Bus, Publish
from protocol.messages import Halt, Reading, Resume, Shared, Stopped
from protocol.scenario import RobotScenario


@dataclass(frozen=True, slots=True)
class Wires:
    """A robot's publications."""

    tell: Publish  # its shared state
    drive: Publish
    report: Publish
    linked: Publish  # who of its neighbours is linked to it


def wire(bus: Bus, view: RobotScenario) -> Wires:
    """Subscribe to what robot `view.robot` may hear (its readings, its declared neighbours, the end of the run) and
    declare what it says. In real time a state or a drive that finds no room is not worth waiting for."""
    i = view.robot
    bus.subscribe(keys.robot(i, keys.READING), Reading)
    bus.subscribe(keys.robot(i, keys.RESUME), Resume)
    bus.subscribe(keys.HALT, Halt)
    bus.subscribe(keys.STOPPED, Stopped)
    for j, _ in view.row:
        bus.subscribe(keys.robot(j, keys.SHARED), Shared)
    waits = view.clock == "lockstep"
    leaves = ((keys.SHARED, waits), (keys.DRIVE, waits), (keys.REPORT, True), (keys.LINKED, True))
    return Wires(*(bus.publisher(keys.robot(i, leaf), reliable=reliable) for leaf, reliable in leaves))
