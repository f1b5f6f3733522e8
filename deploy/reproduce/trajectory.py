"""A run of the swarm with the robots' true motion written down, over Zenoh or in memory.

Rules: over Zenoh the truth comes as to a recorder, best effort: a sample may be missing, and then `missed` says so; in
memory none is. Listening changes nothing of the run.
"""

from __future__ import annotations

import secrets
from dataclasses import dataclass
from typing import TYPE_CHECKING

from msgspec.structs import replace

from protocol.messages import Event, Message, Outcome, Progress, Truth
from protocol.scenario import Scenario
from protocol.scenario.sections import Recording

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from deploy.memory_run import MemorySwarm

    Array = NDArray[np.float64]

NEVER = 1e9  # s between two pictures of the plume, which nobody looks at


@dataclass(frozen=True, slots=True)
class Trajectory:
    """What the robots did: arrays over K samples and N robots."""

    outcome: Outcome
    t: Array  # (K,), s; the first is 0
    robots: Array  # (K, N, 9): x, y, theta, nu, omega, tau_left, tau_right, ppt, alive
    missed: int  # samples that did not arrive

    def hands(self, length: float) -> Array:
        """x_i of (1.8), (K, N, 2), m; `length` is L_i."""
        import numpy as np

        x, y, theta = np.moveaxis(self.robots[:, :, :3], 2, 0)
        return np.stack([x + length * np.cos(theta), y + length * np.sin(theta)], axis=2)

    def hand_velocities(self, length: float) -> Array:
        """v_i of (1.9), (K, N, 2), m/s."""
        import numpy as np

        theta, nu, omega = np.moveaxis(self.robots[:, :, 2:5], 2, 0)
        c, s = np.cos(theta), np.sin(theta)
        return np.stack([nu * c - length * omega * s, nu * s + length * omega * c], axis=2)


def record(scenario: Scenario, bus: str, period: float) -> Trajectory:
    """Run `scenario` on the bus "zenoh" or "memory" and keep the truth every `period` seconds of simulated time.

    Raises:
        SwarmFailure: a process failed.
    """
    import numpy as np

    from world_server.start import start_poses

    told = replace(scenario, recording=Recording(truth_period=period, field_period=NEVER))
    truths: list[Truth] = []
    outcome = _over_zenoh(told, truths) if bus == "zenoh" else _in_memory(told, truths)
    first = np.zeros((scenario.robots, 9))
    first[:, :3] = start_poses(scenario)
    first[:, 8] = 1.0
    rows = {0: (0.0, first)}  # at rest at the start, whether or not that sample came
    for truth in truths:
        rows[truth.tick] = (truth.t, np.frombuffer(truth.robots, "<f8").reshape(-1, 9))
    t, robots = zip(*(rows[tick] for tick in sorted(rows)), strict=True)
    wanted = set(range(0, outcome.ticks + 1, max(1, round(period / scenario.timing.tick))))
    return Trajectory(outcome, np.array(t), np.array(robots), len(wanted - rows.keys()))


def _over_zenoh(scenario: Scenario, truths: list[Truth]) -> Outcome:
    from deploy.launch.swarm import SwarmRun

    return SwarmRun(f"run-{secrets.token_hex(4)}", scenario, truth=truths.append).execute(_Nobody())


def _in_memory(scenario: Scenario, truths: list[Truth]) -> Outcome:
    from deploy.memory_run import run_in_memory
    from world_server.telemetry import Telemetry

    telemetry: list[Telemetry] = []

    def take(message: Message) -> None:
        assert isinstance(message, Truth)
        truths.append(message)

    def observe(swarm: MemorySwarm) -> bool:
        if not telemetry:
            telemetry.append(Telemetry(swarm.session.world, take, lambda _: None))
        telemetry[0].tick(last=swarm.session.ended is not None)
        return True

    return run_in_memory(scenario, observe=observe)


class _Nobody:
    """Nobody watches while it runs."""

    def progress(self, progress: Progress) -> None:
        """Not shown."""

    def event(self, event: Event) -> None:
        """Not shown."""
