"""Whom each robot may hear at a tick: the declared graph as it is now.

Rules: pure; what comes out depends on the scenario, the tick and the true places of that tick, on nothing before it. A
graph that neither switches nor depends on the range costs nothing: its rows are made once. What faults take away is
not known here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from protocol.scenario import Edge, Scenario
from protocol.scenario.stage import stage_at

Row = tuple[int, ...]


class Links:
    """The edges that are open, by listener."""

    def __init__(self, scenario: Scenario) -> None:
        stages = scenario.schedule
        self._dt = scenario.timing.tick
        self._starts = [stage.at for stage in stages]
        self._period = scenario.graph_options.period
        self._ranges = [stage.range for stage in stages]
        self._rows = [_rows(stage.edges, scenario.robots) for stage in stages]
        self._moving = len(stages) > 1 or any(self._ranges)
        self.rows: list[Row] = self._rows[0] if stages else _rows(scenario.graph, scenario.robots)
        """`rows[i]`: whom robot i may hear at the tick of the last `advance`, by rising number."""

    def advance(self, tick: int, hands: Callable[[], NDArray[np.float64]]) -> None:
        """Open and close what the schedule and the range say for `tick`.

        Args:
            hands: gives the hand positions at that tick, (N, 2), m; asked only when there is a range.
        """
        if not self._moving:
            return
        stage = stage_at(self._starts, self._period, tick * self._dt)
        self.rows = self._rows[stage]
        if reach := self._ranges[stage]:
            x, y = hands().T
            # The same to the bit whoever asks: squares, no library's root.
            near = ((x[:, None] - x) ** 2 + (y[:, None] - y) ** 2 <= reach * reach).tolist()
            self.rows = [tuple(j for j in row if close[j]) for row, close in zip(self.rows, near, strict=True)]


def _rows(graph: Iterable[Edge], n: int) -> list[Row]:
    heard: list[list[int]] = [[] for _ in range(n)]
    for i, j, _ in graph:
        heard[i].append(j)
    return [tuple(sorted(row)) for row in heard]
