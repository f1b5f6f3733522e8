"""Exactly one verdict in the whole run, and it agrees with the truth.

The truth is worked out again from the bodies: hand x = r + L (cos theta, sin theta), straight from tick to tick; the source
is found at the first tick in which the way of a hand meets the circle of `source.radius` (or, with `source.stop` =
"concentration", at the first sample of enough odour by a robot that is alive). A run that ended as found ended there, by
a robot that got there; any other ended without anybody having got there; a time out is not early. Where the swarm itself
says when it is over (`declaration.stop` = "declared"), getting there ends nothing: whether somebody did must be in the
outcome, and the run never ends as found.
"""

from __future__ import annotations

from itertools import pairwise
from math import cos, hypot, sin

from deploy.checkers.finding import Facts
from deploy.checkers.history import History
from protocol.history.records import Point, Pose, Result, Verdict

ROUNDING = 1e-9
FOUND, TIME_OUT = "found", "time out"


def one_true_verdict(history: History) -> Facts:
    """A fact each: one verdict, one outcome that says the same, the truth agrees."""
    verdicts, results = history.verdicts, history.results
    if len(verdicts) != 1:
        said = "; ".join(f'"{v.reason}" {history.when(v.tick)}' for v in verdicts) or "none"
        yield f"there were {len(verdicts)} verdicts in the run: {said}"
        return
    yield None
    if len(results) != 1:
        yield f"there were {len(results)} outcomes of the run"
        return
    yield None
    verdict, result = verdicts[0], results[0]
    by_word = history.scenario.declaration.stop == "declared"
    agree = result.ended == verdict.reason and (by_word or result.found == (verdict.reason == FOUND))
    says = f'"{result.ended}", found {result.found}'
    yield None if agree else f'the verdict is "{verdict.reason}", but the outcome says {says}'
    yield from _against_truth(history, verdict, result)


def _against_truth(history: History, verdict: Verdict, result: Result) -> Facts:
    """How the verdict differs from the truth."""
    when = history.when(verdict.tick)
    last = history.moved[-1].tick if history.moved else -1
    yield None if verdict.tick == last else f"the verdict fell {when}, but the world went on to tick {last}"
    tick, finders = _arrival(history)
    by_word = history.scenario.declaration.stop == "declared"
    if verdict.reason == FOUND:
        if by_word:
            yield f'the run ended {when} as "{FOUND}", but only the word of the swarm, or its time, was to end it'
            return
        said = f"the source was said to be found {when}"
        if not finders:
            yield f"{said}, but nobody had got there"
            return
        who = f"robot {min(finders)}"
        yield None if tick == verdict.tick else f"{said}, but {who} was there {history.when(tick)} first"
        yield None if result.finder in finders else f"{said} by robot {result.finder}, but it was {who}"
        in_time = result.time <= verdict.tick * history.dt + ROUNDING
        yield None if in_time else f"{said}, and that at {result.time:g} s, after the end of the run"
        return
    ended = f'the run ended {when} as "{verdict.reason}"'
    if by_word:
        right = (result.finder in finders) if finders else not result.found
        who = f"robot {min(finders)} was at the source {history.when(tick)}" if finders else "nobody was at the source"
        yield None if right else f"{ended}, found {result.found} by robot {result.finder}, but {who}"
    else:
        yield None if not finders else f"{ended}, but robot {min(finders)} was at the source {history.when(tick)}"
    early = verdict.reason == TIME_OUT and verdict.tick * history.dt < history.scenario.max_time - ROUNDING
    yield None if not early else f"{ended}, before max_time of {history.scenario.max_time:g} s"


def _arrival(history: History) -> tuple[int, set[int]]:
    """The first tick that sees somebody at the source, and who that is; nobody: -1."""
    scenario, moved = history.scenario, history.moved
    if scenario.plume.release_rate == 0.0:
        return -1, set()
    if scenario.source.stop == "concentration":
        for each in moved:
            enough = scenario.source.stop_concentration
            who = {i for i, ppt in enumerate(each.ppt or ()) if ppt >= enough and i not in each.dead}
            if who:
                return max(1, each.tick), who  # a run ends at its first step at the earliest
        return -1, set()
    for before, after in pairwise(moved):
        who = {
            i
            for i, (p, q) in enumerate(zip(before.poses, after.poses, strict=True))
            if _closest(_hand(p, scenario.body.hand), _hand(q, scenario.body.hand), (scenario.source.x, scenario.source.y))
            <= scenario.source.radius + ROUNDING
        }
        if who:
            return after.tick, who
    return -1, set()


def _hand(pose: Pose, L: float) -> Point:
    x, y, theta, _, _ = pose
    return x + L * cos(theta), y + L * sin(theta)


def _closest(p: Point, q: Point, centre: Point) -> float:
    """Least distance of the straight way from p to q from `centre`, m."""
    dx, dy = q[0] - p[0], q[1] - p[1]
    cx, cy = centre[0] - p[0], centre[1] - p[1]
    length2 = dx * dx + dy * dy
    s = min(1.0, max(0.0, (cx * dx + cy * dy) / length2)) if length2 > 0.0 else 0.0
    return hypot(cx - s * dx, cy - s * dy)
