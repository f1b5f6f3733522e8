"""The declared graph of the moment, worked out from the scenario alone: what the world and the robots did is not asked."""

from __future__ import annotations

from collections.abc import Mapping

from protocol.scenario import Scenario
from protocol.scenario.stage import stage_at

Weights = Mapping[tuple[int, int], float]  # a_ij by (i, j)


class Declared:
    """The edges of a scenario by tick."""

    def __init__(self, scenario: Scenario) -> None:
        self._dt = scenario.timing.tick
        self._starts = [stage.at for stage in scenario.schedule]
        self._period = scenario.graph_options.period
        graphs = [stage.edges for stage in scenario.schedule] or [scenario.graph]
        self._graphs: list[Weights] = [{(i, j): a_ij for i, j, a_ij in graph} for graph in graphs]

    def at(self, tick: int) -> Weights:
        """a_ij at `tick`."""
        if len(self._graphs) == 1:
            return self._graphs[0]
        return self._graphs[stage_at(self._starts, self._period, tick * self._dt)]

    @property
    def max_degree(self) -> float:
        """Largest row sum that there ever is."""
        sums: dict[tuple[int, int], float] = {}
        for n, graph in enumerate(self._graphs):
            for (i, _), a_ij in graph.items():
                sums[n, i] = sums.get((n, i), 0.0) + a_ij
        return max(sums.values(), default=0.0)
