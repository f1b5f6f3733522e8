"""How a run ended, as one record."""

from __future__ import annotations

from itertools import combinations
from math import dist, hypot

from protocol.bus import Counters
from protocol.messages import Outcome
from protocol.scenario import scenario_digest
from world_server.declarations import WRONG
from world_server.realtime_session import RealtimeWorldSession
from world_server.session import ALL_STOPPED, DECLARED, FOUND, INTERRUPTED, TIME_OUT, WorldSession


def outcome(session: WorldSession, run: str, wall_s: float, counters: Counters) -> Outcome:
    """The outcome of a session that is over.

    Args:
        run: name of the run.
        wall_s: wall-clock s from the first tick to the last.
        counters: what went over the world's own wires; the robots' come with their reports.
    """
    world = session.world
    scenario = world.scenario
    reports = session.reports
    x, y = scenario.source.x, scenario.source.y
    errors = tuple(
        hypot(r.h_x - x, r.h_y - y) if (r := reports.get(i)) and r.has_estimate else None
        for i in range(scenario.robots)
    )
    estimates = [(r.h_x, r.h_y) for r in reports.values() if r.has_estimate]
    messages = {
        "sent": counters.sent + sum(r.sent for r in reports.values()),
        "received": counters.received + sum(r.received for r in reports.values()),
        "dropped": counters.dropped + session.dropped + sum(r.dropped for r in reports.values()),
        "refused": counters.refused + sum(r.refused for r in reports.values()),
    }
    found = world.found
    ended = session.ended or INTERRUPTED
    declared = session.declarations
    common, at = declared.common, declared.at
    source = (x, y) if scenario.plume.release_rate > 0.0 else None
    off = declared.error(source)
    return Outcome(
        found=found is not None,
        time=found.t if found and ended == FOUND else world.t,
        finder=found.robot if found else -1,
        ticks=world.tick,
        wall_s=wall_s,
        ticks_per_s=world.tick / wall_s if wall_s > 0 else 0.0,
        digest=world.digest,
        distance_travelled=tuple(world.bodies.travelled.tolist()),
        estimate_error=errors,
        min_pair_distance=world.verdict.min_pair_distance,
        run=run,
        seed=scenario.seed,
        scenario_digest=scenario_digest(scenario),
        faults=tuple(session.faults),
        messages=messages,
        ended=ended,
        failed=ended not in (FOUND, DECLARED, TIME_OUT, INTERRUPTED, ALL_STOPPED),
        first_detection=world.first_detection,
        clock=scenario.clock,
        missed=tuple(session.missed) if isinstance(session, RealtimeWorldSession) else (),
        behind=session.behind if isinstance(session, RealtimeWorldSession) else 0.0,
        slip=session.slip if isinstance(session, RealtimeWorldSession) else 0.0,
        disagreement=max((dist(one, other) for one, other in combinations(estimates, 2)), default=None),
        declared=common is not None,
        declared_at=at,
        declared_by=common[1] if common else -1,
        declared_x=common[2] if common else None,
        declared_y=common[3] if common else None,
        declaration_error=off,
        reached_at=found.t if found else None,
        declaration_delay=at - found.t if found and at is not None else None,
        false_declaration=common is not None and (off is None or off > WRONG),
    )
