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
from protocol.scenario.faults import AnyFault, OwnFault
from protocol.scenario.graph_options import GraphOptions
from protocol.scenario.realtime import Realtime
from protocol.scenario.stage import Edge, RowStage, Stage
from protocol.scenario.supervision import Supervision
from protocol.scenario.table import Count, Table
from protocol.scenario.trust import Trust


class Scenario(Table, frozen=True):
    """All that decides a run."""

    seed: Annotated[int, Meta(ge=0, le=2**63 - 1)] = 0
    robots: Count = 5  # N
    algorithm: str = "cfpso"
    topology: str = "ring"  # a name, or the path of a graph file; of a schedule its stages in a few words
    preset: Literal["corrected", "literal"] = "corrected"
    case: Annotated[int, Meta(ge=0, le=9)] = 0  # of Table 4.6; 0: none
    max_time: Annotated[float, Meta(gt=0, le=1e6)] = 1000.0  # simulated s; the thesis stops at 1000 or 1500
    clock: Literal["lockstep", "realtime"] = "lockstep"  # wait for the robots, or follow the wall clock
    graph: tuple[Edge, ...] = ()  # all edges that there ever are; filled in from `topology`
    schedule: tuple[Stage, ...] = ()  # which of them when; empty: all of them always. Given as [[topology]]
    arena: s.Arena = s.Arena()
    source: s.Source = s.Source()
    wind: s.Wind = s.Wind()
    plume: s.Plume = s.Plume()
    sensors: s.Sensors = s.Sensors()
    body: s.Body = s.Body()
    start: s.Start = s.Start()
    timing: s.Timing = s.Timing()
    realtime: Realtime = Realtime()
    search: s.Search = s.Search()
    decision: s.Decision = s.Decision()
    fusion: s.Fusion = s.Fusion()
    planning: s.Planning = s.Planning()
    control: s.Control = s.Control()
    trust: Trust = Trust()
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
    graph_options: GraphOptions = GraphOptions()
    network: s.Network = s.Network()
    recording: s.Recording = s.Recording()
    supervision: Supervision = Supervision()
    faults: tuple[AnyFault, ...] = ()  # what goes wrong, and when


class RobotScenario(Table, frozen=True):
    """What robot `robot` may know of the scenario: itself, its own row of the graph, and the parameters of the laws."""

    robot: int
    robots: int
    seed: int
    algorithm: str
    row: tuple[tuple[int, float], ...]  # (j, a_ij): whom it ever listens to
    stages: tuple[RowStage, ...]  # whom it listens to when; empty: to its row always
    period: float  # after which the stages begin anew, s; 0: never
    linked: tuple[int, ...]  # robots that it has a link with, in either direction
    reaches: tuple[int, ...]  # robots that ever listen to it
    max_degree: float  # largest row sum at any time: bounds the step of the consensus laws
    proximity: float  # how far it senses others, m; 0: not at all
    complete: bool  # everyone hears everyone at any time: positions need no relaying
    arena: s.Arena
    body: s.Body
    clock: Literal["lockstep", "realtime"]
    timing: s.Timing
    realtime: Realtime
    search: s.Search
    decision: s.Decision
    fusion: s.Fusion
    planning: s.Planning
    control: s.Control
    trust: Trust
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
    supervision: Supervision
    faults: tuple[OwnFault, ...]  # what it acts out itself: how it lies, how its clock is wrong


LEASE_PER_ROBOT = 40  # ms


def robots_per_column(scenario: Scenario) -> int:
    """How many robots stand above each other at the start before a further column is begun."""
    start = scenario.start
    return max(1, int((scenario.arena.y_max - start.y) // start.spacing) + 1)


def proximity(scenario: Scenario) -> float:
    """How far robots sense each other, m: what `sensors` say, or else what the algorithm asks for in its own table."""
    if scenario.sensors.proximity is not None:
        return scenario.sensors.proximity
    own = getattr(scenario, scenario.algorithm.replace("-", "_"), None)
    return float(getattr(own, "proximity", 0.0))


def lease_ms(network: s.Network, robots: int, clock: str) -> int:
    """After how long a silent link is dead, ms: `network.lease_ms`, and longer for a large swarm, which shares a machine's
    processors and would otherwise lose each other while it starts. In real time who is lost comes back."""
    if clock == "realtime":
        return network.lease_ms
    return max(network.lease_ms, LEASE_PER_ROBOT * robots)


def linked_to(graph: tuple[Edge, ...], i: int) -> tuple[int, ...]:
    """Robots that share a physical link with robot `i`: those it listens to and those that listen to it."""
    heard = {j for a, j, _ in graph if a == i}
    return tuple(sorted((heard | {a for a, j, _ in graph if j == i}) - {i}))


def robot_view(scenario: Scenario, i: int) -> RobotScenario:
    """What robot `i` may know of `scenario`."""
    stages = scenario.schedule
    graphs = [stage.edges for stage in stages] or [scenario.graph]
    everyone = scenario.robots * (scenario.robots - 1)
    both = set(RobotScenario.__struct_fields__) & set(Scenario.__struct_fields__) - {"robots", "seed", "algorithm", "faults"}
    return RobotScenario(
        robot=i,
        robots=scenario.robots,
        seed=scenario.seed,
        algorithm=scenario.algorithm,
        row=_row(scenario.graph, i),
        stages=tuple(RowStage(stage.at, _row(stage.edges, i)) for stage in stages),
        period=scenario.graph_options.period,
        linked=linked_to(scenario.graph, i),
        reaches=tuple(sorted(k for k, j, _ in scenario.graph if j == i)),
        max_degree=max(_largest_row_sum(graph) for graph in graphs),
        proximity=proximity(scenario),
        complete=all(len(graph) == everyone for graph in graphs) and not any(stage.range > 0.0 for stage in stages),
        faults=tuple(f for f in scenario.faults if isinstance(f, OwnFault) and f.robot == i),
        **{name: getattr(scenario, name) for name in both},
    )


def _row(graph: tuple[Edge, ...], i: int) -> tuple[tuple[int, float], ...]:
    return tuple(sorted((j, a_ij) for k, j, a_ij in graph if k == i))


def _largest_row_sum(graph: tuple[Edge, ...]) -> float:
    degrees: dict[int, float] = {}
    for k, _, a_kj in graph:
        degrees[k] = degrees.get(k, 0.0) + a_kj
    return max(degrees.values(), default=0.0)


def scenario_digest(scenario: Scenario) -> str:
    """16 hex digits that name all that decides the run; neither the wires, the recording nor supervision do, nor real
    time's numbers in lock-step."""
    realtime = scenario.realtime if scenario.clock == "realtime" else Realtime()
    idle = {"network": s.Network(), "recording": s.Recording(), "supervision": Supervision(), "realtime": realtime}
    decisive = msgspec.structs.replace(scenario, **idle)
    return blake2b(msgspec.json.encode(decisive, order="deterministic"), digest_size=8).hexdigest()
