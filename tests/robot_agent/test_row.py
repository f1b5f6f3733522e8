"""A robot knows whom it listens to, with what weight, and forgets nobody who may still be near."""

from __future__ import annotations

from protocol.messages import Shared
from protocol.scenario import RobotScenario, robot_view
from protocol.scenario.load import load_scenario
from robot_agent.neighbours import Neighbours
from robot_agent.row import Row


def view(i: int, **values: object) -> RobotScenario:
    chosen = [(name.replace("__", "."), value, "-") for name, value in values.items()]
    return robot_view(load_scenario(None, overrides=chosen), i)


WEIGHTED = [
    {"at": 0, "name": "a", "edges": [[0, 1, 2.0], [1, 0, 1.0], [2, 0, 1.0]]},
    {"at": 1.0, "name": "b", "edges": [[0, 2, 0.5], [0, 1, 3.0]]},
    {"at": 1.5, "name": "c", "edges": [[0, 2, 4.0]]},
]


def state(robot: int, tick: int) -> Shared:
    return Shared(robot, tick, float(robot), 0.0, 0.1, 0.0, 0.0, 0.0, -1.0, -1.0, 0.0, 0.0, 0.0, 0, 0, 1.0, 0.0, 0.0, 0.0)


def test_the_weights_are_those_of_the_stage_that_rules() -> None:
    row = Row(view(0, robots=3, topology=WEIGHTED, graph_options__period=2.0))
    assert [row.weights(tick) for tick in (0, 19, 20, 29, 30, 39, 40)] == [
        {1: 2.0}, {1: 2.0}, {2: 0.5, 1: 3.0}, {2: 0.5, 1: 3.0}, {2: 4.0}, {2: 4.0}, {1: 2.0},
    ]  # fmt: skip


def test_the_weights_of_a_graph_that_never_changes_are_its_row() -> None:
    row = Row(view(1, topology="line"))
    assert row.weights(0) == row.weights(12345) == {0: 1.0, 2: 1.0}


def test_who_is_no_neighbour_any_more_is_out_of_the_sums_at_once_and_still_kept_clear_of() -> None:
    neighbours = Neighbours(view(0, robots=3, topology=WEIGHTED))
    neighbours.hear(29, [state(1, 29), state(2, 29)])
    assert [(a, s.robot) for a, s in neighbours.fresh] == [(3.0, 1), (0.5, 2)]
    neighbours.hear(30, [state(2, 30)])
    assert [(a, s.robot) for a, s in neighbours.fresh] == [(4.0, 2)]
    others = neighbours.others(30)
    placed = dict(zip(neighbours.numbers, others, strict=True))
    assert placed[1] == (1.0 + 0.05 * 0.1, 0.0, 0.1, 0.0)
