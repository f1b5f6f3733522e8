"""What a neighbour says, for tests: an honest robot in the middle of the arena that has begun to trace."""

from __future__ import annotations

from msgspec.structs import replace

from protocol.messages import Reading, Shared
from protocol.scenario import RobotScenario, robot_view
from protocol.scenario.load import load_scenario
from robot_agent.hand import Own

DT = 0.05


def view(i: int = 0, **values: object) -> RobotScenario:
    """Robot `i` of a scenario; `values` with "__" for "." override it."""
    chosen = {name.replace("__", "."): value for name, value in values.items()}
    return robot_view(load_scenario(None, overrides=[(name, value, "test") for name, value in chosen.items()]), i)


def own(tick: int, scenario: RobotScenario, x: float = 50.0, y: float = 0.0) -> Own:
    """The robot at rest at `tick`."""
    return Own(reading(tick, scenario.robot, x, y), scenario.body)


def reading(tick: int, robot: int = 0, x: float = 50.0, y: float = 0.0, ppt: float = 0.0, **more: object) -> Reading:
    return Reading(robot, tick, tick * DT, x, y, 0.0, 0.0, 0.0, 1.0, 0.0, ppt, **more)


def told(robot: int, k: int, x: float = 60.0, y: float = 5.0, **changed: object) -> Shared:
    """An honest state of tick `k`, with what is `changed`."""
    t = k * DT
    state = Shared(robot, k, x, y, 0.3, 0.0, 40.0, 2.0, 0.0, t, 900.0, x, y, 0, 0, 0.6, 0.8, 38.0, 1.0, best_at=t)
    return replace(state, **changed)
