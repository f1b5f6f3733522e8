"""Checks between values: each value is allowed by its type already, here they must fit together.

Rules: a check returns one sentence or nothing and knows nothing of files; `check` puts the place in front of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from math import ceil, dist, log

from protocol.errors import ScenarioError
from protocol.scenario.faults.check import faults_in
from protocol.scenario.resolve import union
from protocol.scenario.scenario import Scenario, robots_per_column
from protocol.scenario.settings import placed
from protocol.topology.graph import fault_in

APART = 0.4  # least distance of two centres at the start, m: a P3-DX is 0.381 m wide
HALVINGS = 900  # of an event's weight, in a run: with more of them the first and the last have no common doubles
_NO_ORIGINS: Mapping[str, str] = {}

Fault = tuple[str, tuple[str, ...]]  # a sentence without its place, and the values that it is about


def check(scenario: Scenario, origins: Mapping[str, str] = _NO_ORIGINS) -> Scenario:
    """`scenario` itself when its values fit together.

    Args:
        origins: where each value was given (dotted name -> file or flag), for the sentence.
    Raises: ScenarioError.
    """
    for find in CHECKS:
        for sentence, paths in find(scenario):
            raise ScenarioError(placed(sentence, origins, *paths))
    return scenario


def _arena(scenario: Scenario) -> Iterator[Fault]:
    arena = scenario.arena
    for axis, low, high in (("x", arena.x_min, arena.x_max), ("y", arena.y_min, arena.y_max)):
        if low >= high:
            paths = (f"arena.{axis}_min", f"arena.{axis}_max")
            yield f"{paths[0]} is {low:g} and {paths[1]} is {high:g}; the first must be less than the second.", paths


def _source(scenario: Scenario) -> Iterator[Fault]:
    x, y = scenario.source.x, scenario.source.y
    if not _inside(scenario, x, y):
        where_to = _arena_words(scenario)
        yield f"the source is at ({x:g}, {y:g}); it must be inside the arena, {where_to}.", ("source.x", "source.y")


def _start(scenario: Scenario) -> Iterator[Fault]:
    points, n = scenario.start.positions, scenario.robots
    headings = len(scenario.start.headings)
    if headings not in (0, n):
        paths = ("start.headings", "robots")
        yield f"start.headings has {_count(headings, 'angle')}; it must be empty or have one per robot, {n}.", paths
    if not points:
        yield from _column(scenario)
        return
    if len(points) != n:
        paths = ("start.positions", "robots")
        yield f"start.positions has {_count(len(points), 'point')}; it must have one per robot, {n}.", paths
        return
    for i, (x, y) in enumerate(points):
        if not _inside(scenario, x, y):
            yield (
                f"robot {i} starts at ({x:g}, {y:g}); it must be inside the arena, {_arena_words(scenario)}.",
                ("start.positions",),
            )
        for j in range(i):
            if (gap := dist(points[i], points[j])) < APART:
                yield (
                    f"robots {j} and {i} start {gap:.3g} m apart; they must be at least {APART} m apart.",
                    ("start.positions",),
                )


def _column(scenario: Scenario) -> Iterator[Fault]:
    """The column upwards from (start.x, start.y); what is too many for it stands in further columns, towards -x."""
    start, n, arena = scenario.start, scenario.robots, scenario.arena
    if not _inside(scenario, start.x, start.y):
        yield (
            f"the robots start from ({start.x:g}, {start.y:g}); it must be inside the arena, {_arena_words(scenario)}.",
            ("start.x", "start.y"),
        )
    per_column = robots_per_column(scenario)
    columns = -(-n // per_column)
    if start.x - (columns - 1) * start.spacing < arena.x_min:
        most = per_column * (int((start.x - arena.x_min) // start.spacing) + 1)
        yield (
            f"robots is {n}; it must be at most {most} to start in columns from ({start.x:g}, {start.y:g}),"
            f" {start.spacing:g} m apart, or give start.positions.",
            ("robots", "start.x", "start.y", "start.spacing"),
        )


def _timing(scenario: Scenario) -> Iterator[Fault]:
    timing = scenario.timing
    for whole, part, values in (
        ("timing.tick", "timing.substep", (timing.tick, timing.substep)),
        ("timing.decision", "timing.tick", (timing.decision, timing.tick)),
    ):
        ratio = values[0] / values[1]
        if round(ratio) < 1 or abs(ratio - round(ratio)) > 1e-6:
            yield (
                f"{whole} is {values[0]:g}; it must be a whole multiple of {part}, which is {values[1]:g}.",
                (whole, part),
            )
    if scenario.max_time < timing.tick:
        yield (
            f"max_time is {scenario.max_time:g}; it must be at least one tick, {timing.tick:g} s.",
            ("max_time", "timing.tick"),
        )


def _drill(scenario: Scenario) -> Iterator[Fault]:
    radii, n = len(scenario.drill.radii), scenario.robots
    if radii not in (1, n):
        yield (
            f"drill.radii has {_count(radii, 'number')}; it must have one for all robots, or one per robot, {n}.",
            ("drill.radii", "robots"),
        )


def _network(scenario: Scenario) -> Iterator[Fault]:
    given, wanted = len(scenario.network.endpoints), scenario.robots + 1
    if given not in (0, wanted):
        yield (
            f"network.endpoints has {_count(given, 'entry')}; it must be empty or have {wanted}, the world's first and"
            " then one per robot.",
            ("network.endpoints", "robots"),
        )


def _graph(scenario: Scenario) -> Iterator[Fault]:
    fault = fault_in(scenario.robots, scenario.graph)
    if fault is not None:
        yield f"graph: {fault}.", ("graph", "robots")


def _schedule(scenario: Scenario) -> Iterator[Fault]:
    stages, period = scenario.schedule, scenario.graph_options.period
    if not stages:
        return
    if stages[0].at != 0.0:
        yield f"topology, entry 1: at is {stages[0].at:g}; it must be 0, or there is no graph at the start.", ("topology",)
    for n, (one, next_one) in enumerate(pairwise(stages), 2):
        if next_one.at <= one.at:
            sentence = f"topology, entry {n}: at is {next_one.at:g}; it must be greater than {one.at:g}, the entry before."
            yield sentence, ("topology",)
    if 0.0 < period <= stages[-1].at:
        yield (
            f"graph_options.period is {period:g}; it must be greater than {stages[-1].at:g}, when the last stage of topology"
            " begins, or 0 for a schedule that does not repeat.",
            ("graph_options.period", "topology"),
        )
    if union(stage.edges for stage in stages) != tuple(sorted(scenario.graph)):
        yield "graph is given and topology is a schedule, which has graphs of its own; leave one of them out.", ("graph",)


def _potential(scenario: Scenario) -> Iterator[Fault]:
    p = scenario.ftmcs
    if p.attack > p.defence:
        yield (
            f"ftmcs.attack is {p.attack:g}; it must be at most ftmcs.defence, which is {p.defence:g}, or robots at"
            " distance d would not be at rest.",
            ("ftmcs.attack", "ftmcs.defence"),
        )


def _realtime(scenario: Scenario) -> Iterator[Fault]:
    r = scenario.realtime
    if r.catch_up >= r.late:
        yield (
            f"realtime.catch_up is {r.catch_up:g}; it must be less than realtime.late, which is {r.late:g}, or robots would"
            " stop whenever the world catches up.",
            ("realtime.catch_up", "realtime.late"),
        )


def _faults(scenario: Scenario) -> Iterator[Fault]:
    edges = {(i, j) for i, j, _ in scenario.graph}
    yield from faults_in(scenario.faults, scenario.robots, edges, scenario.timing.tick)


def _supervision(scenario: Scenario) -> Iterator[Fault]:
    s = scenario.supervision
    if s.backoff > s.max_backoff:
        yield (
            f"supervision.backoff is {s.backoff:g}; it must be at most supervision.max_backoff, which is {s.max_backoff:g}.",
            ("supervision.backoff", "supervision.max_backoff"),
        )
    if s.checkpoint_every and scenario.clock != "lockstep":
        yield (
            f'supervision.checkpoint_every is {s.checkpoint_every:g}; it must be 0 with clock = "{scenario.clock}", for'
            " only in lock-step a world can go on where it was.",
            ("supervision.checkpoint_every", "clock"),
        )


def _forgetting(scenario: Scenario) -> Iterator[Fault]:
    forget, least = scenario.plume_map.forget, ceil(100.0 * scenario.max_time / (HALVINGS * log(2.0))) / 100.0
    if scenario.algorithm == "plume-map" and forget < least:
        yield (
            f"plume_map.forget is {forget:g}; it must be at least {least:g} where max_time is {scenario.max_time:g}, for a"
            f" map can hold {HALVINGS} half-lives.",
            ("plume_map.forget", "max_time"),
        )


CHECKS: tuple[Callable[[Scenario], Iterator[Fault]], ...] = (
    _arena, _source, _start, _timing, _drill, _network, _graph, _schedule, _faults, _potential, _realtime,
    _supervision, _forgetting,
)


def _inside(scenario: Scenario, x: float, y: float) -> bool:
    arena = scenario.arena
    return arena.x_min <= x <= arena.x_max and arena.y_min <= y <= arena.y_max


def _arena_words(scenario: Scenario) -> str:
    arena = scenario.arena
    return f"x from {arena.x_min:g} to {arena.x_max:g} and y from {arena.y_min:g} to {arena.y_max:g}"


def _count(n: int, noun: str) -> str:
    plural = noun[:-1] + "ies" if noun.endswith("y") else noun + "s"
    return f"{n} {noun if n == 1 else plural}"
