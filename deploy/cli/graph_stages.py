"""A graph that changes: its stages, one by one and taken together, and how well connected it is over time.

Rules: the stages come from the scenario, as the swarm gets them. Whom the range parts depends on where the robots are:
at the start, or along a run in memory; the report says which.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deploy.memory_run import MemorySwarm, run_in_memory
from protocol.scenario import Scenario, Stage
from protocol.scenario.resolve import union
from protocol.scenario.stage import stage_at
from protocol.topology.analysis import Analysis, analyse
from protocol.topology.graph import Graph
from world_server.links import Links
from world_server.start import start_poses

AFTER = 0.5  # of the last stage of a schedule that does not repeat, this part of the time before is shown
Sample = tuple[float, float, bool]  # t, s; lambda_2; whether all robots hang together


@dataclass(frozen=True, slots=True)
class Part:
    """One stage as it is looked at."""

    stage: Stage
    graph: Graph  # of a stage with a range: what is left of it at the start
    analysis: Analysis


@dataclass(frozen=True, slots=True)
class Stages:
    """A whole schedule."""

    parts: tuple[Part, ...]
    period: float  # s; 0: it does not repeat
    joint: Analysis  # of all edges of all parts together
    mean: Analysis  # of the graph whose weights are the mean ones over a period; of one that ends: of its last stage
    over_time: tuple[Sample, ...]  # each value until the next one's time
    followed: bool  # along a run; otherwise by the schedule, with the robots where they start


def stages_of(scenario: Scenario, *, follow: bool) -> Stages:
    """What there is to know of the schedule of `scenario`, which has one."""
    n, period = scenario.robots, scenario.graph_options.period
    at_start = _hands(scenario)
    parts = []
    for stage in scenario.schedule:
        graph = Graph(n, _near(stage, at_start))
        parts.append(Part(stage, graph, analyse(graph)))
    followed = follow and bool(parts)
    return Stages(
        parts=tuple(parts),
        period=period,
        joint=analyse(Graph(n, union(part.graph.edges for part in parts))),
        mean=analyse(_mean(parts, n, period)),
        over_time=_along_a_run(scenario) if followed else _by_the_schedule(parts, period),
        followed=followed,
    )


def _hands(scenario: Scenario) -> NDArray[np.float64]:
    x, y, theta = start_poses(scenario).T
    length = scenario.body.hand
    return np.column_stack((x + length * np.cos(theta), y + length * np.sin(theta)))


def _near(stage: Stage, hands: NDArray[np.float64]) -> tuple[tuple[int, int, float], ...]:
    if not stage.range:
        return stage.edges
    gap = np.linalg.norm(hands[:, None] - hands, axis=-1)
    return tuple(edge for edge in stage.edges if gap[edge[0], edge[1]] <= stage.range)


def _mean(parts: list[Part], n: int, period: float) -> Graph:
    if period <= 0.0:
        return parts[-1].graph
    ends = [*(part.stage.at for part in parts[1:]), period]
    weights: dict[tuple[int, int], float] = {}
    for part, end in zip(parts, ends, strict=True):
        for i, j, a_ij in part.graph.edges:
            weights[i, j] = weights.get((i, j), 0.0) + a_ij * (end - part.stage.at) / period
    return Graph(n, tuple((i, j, a_ij) for (i, j), a_ij in sorted(weights.items())))


def _sample(t: float, analysis: Analysis) -> Sample:
    return t, analysis.lambda_2 or 0.0, analysis.connected


def _by_the_schedule(parts: list[Part], period: float) -> tuple[Sample, ...]:
    """Two periods, or all stages and a while of the last one."""
    samples = [_sample(part.stage.at, part.analysis) for part in parts]
    if period > 0.0:
        return (*samples, *((t + period, value, whole) for t, value, whole in samples), (2 * period, *samples[-1][1:]))
    end = parts[-1].stage.at * (1 + AFTER) or 1.0
    return (*samples, (end, *samples[-1][1:]))


def _along_a_run(scenario: Scenario) -> tuple[Sample, ...]:
    """A sample at every decision of a run in memory."""
    every = round(scenario.timing.decision / scenario.timing.tick)
    links, dt = Links(scenario), scenario.timing.tick
    starts = [stage.at for stage in scenario.schedule]
    weights = [{(i, j): a_ij for i, j, a_ij in stage.edges} for stage in scenario.schedule]
    known: dict[tuple[int, tuple[tuple[int, ...], ...]], Analysis] = {}
    samples: list[Sample] = []

    def look(swarm: MemorySwarm) -> bool:
        world = swarm.session.world
        # The last tick is shown twice: the run is over when the last words are said.
        if world.tick % every == 0 and not (samples and samples[-1][0] == world.t):
            links.advance(world.tick, world.bodies.hands)
            stage = stage_at(starts, scenario.graph_options.period, world.tick * dt)
            key = (stage, tuple(links.rows))
            if key not in known:
                edges = tuple((i, j, weights[stage][i, j]) for i, row in enumerate(links.rows) for j in row)
                known[key] = analyse(Graph(scenario.robots, edges))
            samples.append(_sample(world.t, known[key]))
        return True

    run_in_memory(scenario, observe=look)
    return tuple(samples)
