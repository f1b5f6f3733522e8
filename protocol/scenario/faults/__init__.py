"""Faults as data: one small file per kind, and here the list of all.

Rules: a new kind is one new file here, one line in `AnyFault`, and its effect in `world_server.faults` or
`robot_agent.faults`.
"""

from __future__ import annotations

from protocol.scenario.faults.actuator import Actuator
from protocol.scenario.faults.base import FOREVER, Edges, Fault, OnEdges, Passing, first_tick
from protocol.scenario.faults.clock_skew import ClockSkew
from protocol.scenario.faults.crash import Crash
from protocol.scenario.faults.delay import Delay
from protocol.scenario.faults.duplicate import Duplicate
from protocol.scenario.faults.hang import Hang
from protocol.scenario.faults.liar import Liar
from protocol.scenario.faults.loss import Loss
from protocol.scenario.faults.partition import Partition
from protocol.scenario.faults.reorder import Reorder
from protocol.scenario.faults.sensor import Sensor
from protocol.scenario.faults.world_slow import WorldSlow

AnyFault = (
    Crash | Hang | Loss | Delay | Duplicate | Reorder | Partition | ClockSkew | Sensor | Actuator | Liar | WorldSlow
)
OwnFault = ClockSkew | Liar  # what a robot acts out itself; a robot knows no other fault

KINDS: dict[str, type[Fault]] = {
    str(kind.__struct_config__.tag): kind
    for kind in (Crash, Hang, Loss, Delay, Duplicate, Reorder, Partition, ClockSkew, Sensor, Actuator, Liar, WorldSlow)
}

HISTORY = 64  # ticks that a robot keeps its neighbours' states: what arrives later than that cannot be heard

__all__ = [
    "FOREVER", "HISTORY", "KINDS", "Actuator", "AnyFault", "ClockSkew", "Crash", "Delay", "Duplicate", "Edges", "Fault",
    "Hang", "Liar", "Loss", "OnEdges", "OwnFault", "Partition", "Passing", "Reorder", "Sensor", "WorldSlow", "first_tick",
]  # fmt: skip
