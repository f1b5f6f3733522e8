"""The truth: plume, wind, bodies, sensors, radio and verdict, advanced one tick at a time.

Rules: pure; a tick is `step(t0, t1, drives) -> readings`. Nothing in it depends on who asks or when. The field does not
depend on the robots, so `prepare()` may advance it early, while the robots think; the result is the same to the bit.
"""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from hashlib import blake2b

import numpy as np

from protocol.messages import Drive, Reading
from protocol.scenario import Scenario, proximity
from world_server import sensors
from world_server.bodies import Bodies
from world_server.faults.actuator import ActuatorFaults
from world_server.faults.memory import recall, remember
from world_server.faults.sensor import SensorFaults
from world_server.field import Field
from world_server.links import Links
from world_server.observer import Observer
from world_server.proximity import near
from world_server.radio import Radio
from world_server.snapshot import VERSION, WorldState, decode, encode, pack, unpack
from world_server.start import start_poses
from world_server.verdict import Found, Verdict


class World:
    """The truth of one run."""

    def __init__(self, scenario: Scenario, saved: WorldState | None = None) -> None:
        """The world at t = 0, or where it was `saved`."""
        self.scenario = scenario
        self.observer: Observer | None = None
        self.tick = 0
        self.dt = scenario.timing.tick
        self.live: set[int] = set(range(scenario.robots))
        self.links = Links(scenario)
        self.radio = Radio(scenario, self.links)
        poses = start_poses(scenario)
        self.bodies = Bodies(scenario.body, scenario.timing, poses[:, 0], poses[:, 1], poses[:, 2])
        hands = self.bodies.hands()
        self.field = Field(scenario)
        self._wind_past = self.field.warm_up(hands) if saved is None else unpack(saved.wind_past, -1, scenario.robots, 2)
        self.verdict = Verdict(scenario.source if scenario.plume.release_rate > 0.0 else None, hands)
        self.first_detection: float | None = None
        self.first_detector = -1
        self.detections = 0
        self.torques: tuple[list[float], list[float]] = ([0.0] * scenario.robots, [0.0] * scenario.robots)
        self._ticks_per_decision = round(scenario.timing.decision / scenario.timing.tick)
        self.ticks_per_sample = max(1, round(scenario.sensors.period / scenario.timing.tick))
        self._noisy = sensors.noisy(scenario.sensors)
        self._proximity = proximity(scenario)
        self._sensor_faults = SensorFaults(scenario)
        self._actuator_faults = ActuatorFaults(scenario)
        # The digest is a chain, for a hash under way cannot be saved: whenever the plume is sampled, the digest of
        # (the digest before, what happened since).
        self._chain = b""
        self._history: list[float] = []  # since then
        self.concentration = [0.0] * scenario.robots
        self._wind: tuple[list[float], list[float]] = ([0.0] * scenario.robots, [0.0] * scenario.robots)
        if saved is None:
            self._sense()
        else:
            self._restore(saved)

    @classmethod
    def restore(cls, scenario: Scenario, snapshot: bytes) -> World:
        """The world of `scenario` as `snapshot` left it; it goes on to the bit as if it had never stopped.

        Raises: SwarmFailure when the snapshot is of another version.
        """
        return cls(scenario, decode(snapshot))

    def snapshot(self) -> bytes:
        """All that decides the future, between two steps; the scenario is not in it."""
        (left, right), (wind_x, wind_y) = self.torques, self._wind
        return encode(
            WorldState(
                VERSION,
                self.tick,
                tuple(sorted(self.live)),
                self.field.state,
                self.bodies.state,
                self.verdict.state,
                self.first_detection,
                self.first_detector,
                self.detections,
                (tuple(left), tuple(right)),
                tuple(self.concentration),
                (tuple(wind_x), tuple(wind_y)),
                pack(self._wind_past) if self.tick == 0 else b"",
                self._chain,
                pack(self._history),
                remember(self.radio, self._sensor_faults),
            )
        )

    def _restore(self, s: WorldState) -> None:
        self.tick = s.tick
        self.live = set(s.live)
        self.field.restore(s.air)
        self.bodies.restore(s.bodies)
        self.verdict.restore(s.verdict)
        self.first_detection, self.first_detector, self.detections = s.first_detection, s.first_detector, s.detections
        self.torques = (list(s.torques[0]), list(s.torques[1]))
        self.concentration = list(s.concentration)
        self._wind = (list(s.wind[0]), list(s.wind[1]))
        self._chain, self._history = s.chain, unpack(s.history, -1).tolist()
        recall(s.faults, self.radio, self._sensor_faults)

    @property
    def t(self) -> float:
        """Simulated time, s."""
        return self.tick * self.dt

    @property
    def next_t(self) -> float:
        """Time of the next tick, s."""
        return (self.tick + 1) * self.dt

    @property
    def found(self) -> Found | None:
        """Who reached the source and when, if anyone did."""
        return self.verdict.found

    @property
    def digest(self) -> str:
        """32 hex digits that name the truth history up to now: robots and what they sense at every tick, the plume
        whenever it is sampled."""
        return self._link(b"").hex()

    @property
    def closest(self) -> float:
        """Distance of the robot that is nearest to the source now, m."""
        source = self.scenario.source
        return float(np.hypot(*(self.bodies.hands() - (source.x, source.y)).T).min())

    def lose(self, robot: int) -> None:
        """A robot died: its body brakes, it senses and drives no more."""
        self.live.discard(robot)
        self.bodies.brake([i not in self.live for i in range(self.scenario.robots)])

    def admit(self, robot: int) -> None:
        """A robot takes part (again) from this tick on: its brake is off, it senses, is heard, and drives."""
        self.live.add(robot)
        self.bodies.brake([i not in self.live for i in range(self.scenario.robots)])
        self.radio.admit(robot, self.tick)

    def prepare(self, ticks: int = 1) -> None:
        """Advance the field by up to `ticks` ticks from now, which is otherwise done when its sensors sample; the robots'
        drives cannot change it. Many steps in a row cost half as much as one now and then."""
        self.field.advance_to((self.tick + ticks) * self.dt)

    def step(self, t0: float, t1: float, drives: Mapping[int, Drive]) -> list[Reading]:
        """`advance`, and what the live robots sense then."""
        self.advance(t0, t1, drives)
        return self.readings()

    def advance(self, t0: float, t1: float, drives: Mapping[int, Drive]) -> None:
        """Move everything from t0, which is now, to t1, the next tick.

        Args:
            t0, t1: s.
            drives: wheel torques by robot; a robot without one rolls on without torque, a dead one brakes.
        """
        if abs(t0 - self.t) > 1e-9 or abs(t1 - self.next_t) > 1e-9:
            raise ValueError(f"the world is at {self.t} s and steps to {self.next_t} s, not from {t0} to {t1}")
        n = self.scenario.robots
        left, right = self.torques = [0.0] * n, [0.0] * n
        for i, drive in drives.items():
            left[i], right[i] = drive.tau_left, drive.tau_right
        self._actuator_faults.weaken(self.tick, left, right)
        path = self.bodies.step(left, right)
        self.verdict.judge(path, t0)
        self.tick += 1
        self._sense()
        if self.observer is not None:
            self.observer.stepped(drives, sampled=self.tick % self.ticks_per_sample == 0)

    def readings(self) -> list[Reading]:
        """What the live robots sense now."""
        s, k, t = self.scenario, self.tick, self.t
        self.links.advance(k, self.bodies.hands)
        live, hears, (wind_x, wind_y), ppt = self.live, self.radio.hears, self._wind, self.concentration
        history: tuple[tuple[float, float], ...] = ()
        around = near(self.bodies.robots, self._proximity) if self._proximity else ()
        readings = []
        for i, b in enumerate(self.bodies.robots):
            if i in live:
                if k == 0:
                    history = tuple((float(u), float(v)) for u, v in self._wind_past[:, i])
                seen_by = around[i] if around else ()
                exact = Reading(
                    i, k, t, b.x, b.y, b.theta, b.nu, b.omega, wind_x[i], wind_y[i], ppt[i], hears(i, k, live), history,
                    0.0, seen_by,
                )  # fmt: skip
                seen = sensors.observe(exact, s.sensors, s.seed) if self._noisy else exact
                readings.append(self._sensor_faults.observe(seen) if self._sensor_faults.any else seen)
        if self.observer is not None:
            self.observer.told(k, readings)
        return readings

    def _sense(self) -> None:
        if self.tick % self.ticks_per_sample == 0:
            # Wind and gas sensors hold their value in between.
            self.field.advance_to(self.t)
            xs, ys = self.bodies.hands().T
            u, v = self.field.wind.at(xs, ys)
            self._wind = (u.tolist(), v.tolist())
            self.concentration = self.field.plume.concentration(xs, ys).tolist()
            self.verdict.smell(self.concentration, self.t, self.live)
            self._history += [*u, *v, *self.concentration]
            self._chain = self._link(self.field.plume.snapshot().tobytes())
            self._history.clear()
        if self.tick % self._ticks_per_decision == 0:
            self._note_detections()
        for b in self.bodies.robots:
            self._history += (b.x, b.y, b.theta, b.nu, b.omega)

    def _link(self, plume: bytes) -> bytes:
        """The next link of the chain."""
        link = blake2b(self._chain, digest_size=16)
        link.update(array("d", self._history).tobytes())
        link.update(plume)
        return link.digest()

    def _note_detections(self) -> None:
        above = [i for i, ppt in enumerate(self.concentration) if ppt > self.scenario.decision.threshold]
        self.detections += len(above)
        if above and self.first_detection is None:
            self.first_detection = self.t
            self.first_detector = above[0]
