"""Sensors that are stuck, biased, dropped out or noisy.

Rules: acts on what the robot is told, after the sensors' own noise; the truth is not touched. Draws by ("sensor-fault",
number of the fault, robot, tick). Range finders (`Reading.near`) have no faults.
"""

from __future__ import annotations

import msgspec

from protocol.messages import Reading
from protocol.randomness import rng_for
from protocol.scenario import Scenario
from protocol.scenario.faults import Sensor

FIELDS = {"concentration": ("concentration",), "wind": ("wind_x", "wind_y"), "position": ("x", "y"), "heading": ("theta",)}
SILENT = ("concentration", "wind")  # these read 0 without a signal; odometry stays where it was


class SensorFaults:
    """All of a run."""

    def __init__(self, scenario: Scenario) -> None:
        dt, self._seed = scenario.timing.tick, scenario.seed
        self.held: dict[int, tuple[float, ...]] = {}  # number of the fault -> what it read last, or first when it is stuck
        self._faults = [(n, *f.ticks(dt), f) for n, f in enumerate(scenario.faults) if isinstance(f, Sensor)]

    @property
    def any(self) -> bool:
        """Whether there are any."""
        return bool(self._faults)

    def observe(self, reading: Reading) -> Reading:
        """`reading` as the robot's faulty sensors report it."""
        for n, first, end, fault in self._faults:
            if fault.robot == reading.robot and first <= reading.tick < end:
                reading = self._observe(reading, n, fault)
        return reading

    def _observe(self, reading: Reading, n: int, fault: Sensor) -> Reading:
        names, value = FIELDS[fault.which], fault.strength
        values = tuple(getattr(reading, name) for name in names)
        draws = rng_for(self._seed, "sensor-fault", n, fault.robot, reading.tick)
        if fault.how == "stuck":
            values = self.held.get(n, values)
        elif fault.how == "bias":
            values = tuple(v + value for v in values)
        elif fault.how == "noise":
            values = tuple(v + value * draws.normal() for v in values)
        elif draws.uniform() < value:
            values = (0.0,) * len(values) if fault.which in SILENT else self.held.get(n, values)
        if fault.which == "concentration":
            values = (max(0.0, values[0]),)
        self.held[n] = values
        return msgspec.structs.replace(reading, **dict(zip(names, values, strict=True)))
