"""A whole experiment as one frozen record, and the part of it that a robot may know.

Rules: `Scenario` is complete, the graph included: two runs of one scenario are the same run. `RobotScenario` holds no
source position, no plume, no true wind and no other robot's start: what a robot cannot know is not in its tables.
"""

from __future__ import annotations

from hashlib import blake2b
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from protocol.scenario import laws
from protocol.scenario import sections as s
from protocol.scenario.table import Count, Table

Edge = tuple[int, int, float]  # (i, j, a_ij): robot i listens to robot j with weight a_ij


class Scenario(Table, frozen=True):
    """All that decides a run."""

    seed: Annotated[int, Meta(ge=0, le=2**63 - 1)] = 0
    robots: Count = 5  # N
    algorithm: str = "cfpso"
    topology: str = "ring"  # a name, or the path of a graph file
    preset: Literal["corrected", "literal"] = "corrected"
    case: Annotated[int, Meta(ge=0, le=9)] = 0  # of Table 4.6; 0: none
    max_time: Annotated[float, Meta(gt=0, le=1e6)] = 1000.0  # simulated s; the thesis stops at 1000 or 1500
    graph: tuple[Edge, ...] = ()  # the edges; filled in from `topology`
    arena: s.Arena = s.Arena()
    source: s.Source = s.Source()
    wind: s.Wind = s.Wind()
    plume: s.Plume = s.Plume()
    sensors: s.Sensors = s.Sensors()
    body: s.Body = s.Body()
    start: s.Start = s.Start()
    timing: s.Timing = s.Timing()
    search: s.Search = s.Search()
    decision: s.Decision = s.Decision()
    fusion: s.Fusion = s.Fusion()
    planning: s.Planning = s.Planning()
    control: s.Control = s.Control()
    declaration: s.Declaration = s.Declaration()
    simple: laws.Simple = laws.Simple()
    repulsion: laws.Repulsion = laws.Repulsion()
    pso: laws.Pso = laws.Pso()
    cpso: laws.Cpso = laws.Cpso()
    consensus: laws.Consensus = laws.Consensus()
    spiral: laws.Spiral = laws.Spiral()
    cfpso: laws.Cfpso = laws.Cfpso()
    cfpso_ft: laws.CfpsoFt = laws.CfpsoFt()
    dcs: laws.Dcs = laws.Dcs()
    dcs_ft: laws.DcsFt = laws.DcsFt()
    ftmcs: laws.Ftmcs = laws.Ftmcs()
    wui: laws.Wui = laws.Wui()
    ppso_im: laws.PpsoIm = laws.PpsoIm()
    lpso: laws.Lpso = laws.Lpso()
    ccs: laws.Ccs = laws.Ccs()
    surge: laws.Surge = laws.Surge()
    walk: laws.Walk = laws.Walk()
    drill: laws.Drill = laws.Drill()
    plume_map: laws.PlumeMap = laws.PlumeMap()
    network: s.Network = s.Network()
    recording: s.Recording = s.Recording()


class RobotScenario(Table, frozen=True):
    """What robot `robot` may know of the scenario: itself, its own row of the graph, and the parameters of the laws."""

    robot: int
    robots: int
    seed: int
    algorithm: str
    row: tuple[tuple[int, float], ...]  # (j, a_ij): whom it listens to
    linked: tuple[int, ...]  # robots that it has a link with, in either direction
    max_degree: float  # largest row sum of the graph: bounds the step of the consensus laws
    complete: bool  # everyone hears everyone: positions need no relaying
    arena: s.Arena
    body: s.Body
    timing: s.Timing
    search: s.Search
    decision: s.Decision
    fusion: s.Fusion
    planning: s.Planning
    control: s.Control
    declaration: s.Declaration
    simple: laws.Simple
    repulsion: laws.Repulsion
    pso: laws.Pso
    cpso: laws.Cpso
    consensus: laws.Consensus
    spiral: laws.Spiral
    cfpso: laws.Cfpso
    cfpso_ft: laws.CfpsoFt
    dcs: laws.Dcs
    dcs_ft: laws.DcsFt
    ftmcs: laws.Ftmcs
    wui: laws.Wui
    ppso_im: laws.PpsoIm
    lpso: laws.Lpso
    ccs: laws.Ccs
    surge: laws.Surge
    walk: laws.Walk
    drill: laws.Drill
    plume_map: laws.PlumeMap
    network: s.Network


def robots_per_column(scenario: Scenario) -> int:
    """How many robots stand above each other at the start before a further column is begun."""
    start = scenario.start
    return max(1, int((scenario.arena.y_max - start.y) // start.spacing) + 1)


def lease_ms(network: s.Network, robots: int) -> int:
    """After how long a silent link is dead, ms: `network.lease_ms`, and longer for more than ten robots, which share a
    machine's processors and would otherwise lose each other while they start."""
    return max(network.lease_ms, network.lease_ms * robots // 10)


def linked_to(graph: tuple[Edge, ...], i: int) -> tuple[int, ...]:
    """Robots that share a physical link with robot `i`: those it listens to and those that listen to it."""
    heard = {j for a, j, _ in graph if a == i}
    return tuple(sorted((heard | {a for a, j, _ in graph if j == i}) - {i}))


def robot_view(scenario: Scenario, i: int) -> RobotScenario:
    """What robot `i` may know of `scenario`."""
    row = tuple(sorted((j, a_ij) for k, j, a_ij in scenario.graph if k == i))
    degrees: dict[int, float] = {}
    for k, _, a_kj in scenario.graph:
        degrees[k] = degrees.get(k, 0.0) + a_kj
    both = set(RobotScenario.__struct_fields__) & set(Scenario.__struct_fields__) - {"robots", "seed", "algorithm"}
    return RobotScenario(
        robot=i,
        robots=scenario.robots,
        seed=scenario.seed,
        algorithm=scenario.algorithm,
        row=row,
        linked=linked_to(scenario.graph, i),
        max_degree=max(degrees.values(), default=0.0),
        complete=len(scenario.graph) == scenario.robots * (scenario.robots - 1),
        **{name: getattr(scenario, name) for name in both},
    )


def scenario_digest(scenario: Scenario) -> str:
    """16 hex digits that name all that decides the run; neither the wires nor the recording do."""
    decisive = msgspec.structs.replace(scenario, network=s.Network(), recording=s.Recording())
    return blake2b(msgspec.json.encode(decisive, order="deterministic"), digest_size=8).hexdigest()
