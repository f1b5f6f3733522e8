"""What happened, as a log; and the run in words, with its outcome when it is over."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np
import rerun as rr
from rerun.chunk import Chunk

from deploy.recorder import palette
from deploy.recorder.chunks import colours, temporal, timeless
from deploy.recorder.layers.bodies import robot_label
from protocol.messages import Event, Outcome
from protocol.scenario import Scenario, scenario_digest

EVENTS, RUN = "events", "run"

_TROUBLE = re.compile(
    r"\b(lost|loss|gone|dead|die[sd]?|kill\w*|crash\w*|hung|hang\w*|fault\w*|fail\w*|broke\w*|cut|stale|missed)\b",
    re.IGNORECASE,
)


def level_of(event: Event) -> rr.TextLogLevel:
    """An event carries no level: what speaks of trouble is a warning, the rest is information."""
    return rr.TextLogLevel.WARN if _TROUBLE.search(event.text) else rr.TextLogLevel.INFO


def log(events: Sequence[Event]) -> Iterator[Chunk]:
    """Lines of the log, in the colour of the robot that they are about."""
    events = sorted(events, key=lambda e: e.tick)
    texts = [_words(e) for e in events]
    shown = colours([palette.TEXT if e.robot < 0 else palette.robot_colour(e.robot) for e in events])
    t = np.array([e.t for e in events], dtype=np.float64)
    ticks = np.array([e.tick for e in events], dtype=np.int64)
    columns = rr.TextLog.columns(text=texts, level=[level_of(e) for e in events], color=shown)
    yield from temporal(EVENTS, t, ticks, columns)


def _words(event: Event) -> str:
    label = robot_label(event.robot)
    return event.text if event.robot < 0 or label in event.text else f"{label}: {event.text}"


def document(run: str, scenario: Scenario, outcome: Outcome | None) -> Iterator[Chunk]:
    """The page that says what this run is and how it ended."""
    yield from timeless(
        RUN, rr.TextDocument(describe(run, scenario, outcome), media_type=rr.MediaType.MARKDOWN)
    )


def _found_when(s: Scenario) -> str:
    if s.source.stop == "concentration":
        return f"when a robot meets {s.source.stop_concentration:g} ppt"
    return f"within {s.source.radius:g} m"


def describe(run: str, scenario: Scenario, outcome: Outcome | None) -> str:
    """The same in Markdown."""
    s = scenario
    rows = [
        ("algorithm", s.algorithm),
        ("robots", f"{s.robots}"),
        ("graph", f"{s.topology}, {len(s.graph)} directed edges"),
        ("source", f"({s.source.x:g}, {s.source.y:g}) m, found {_found_when(s)}"),
        ("wind", f"{s.wind.speed:g} m/s"),
        ("threshold", f"{s.decision.threshold:g} ppt"),
        ("tick, decision", f"{s.timing.tick:g} s, {s.timing.decision:g} s"),
        ("preset, seed", f"{s.preset}, {s.seed}"),
        ("scenario digest", f"`{scenario_digest(s)}`"),
    ]
    setting = f"\n\n### {run}\n\n{_table(rows)}\n"
    if outcome is None:
        return "The run has not ended, or the recorder did not see its end." + setting
    end = f"\n### Outcome\n\n{_table(_outcome(outcome))}\n\n{_per_robot(outcome)}"
    return _verdict(outcome) + setting + end


def _verdict(outcome: Outcome) -> str:
    if outcome.declared:
        off = "there is none" if outcome.declaration_error is None else f"{outcome.declaration_error:.2f} m off"
        place = f"({outcome.declared_x:.2f}, {outcome.declared_y:.2f})"
        return f"The swarm **declared** the source at {place} after {outcome.declared_at:.2f} s: {off}."
    if outcome.found:
        return f"The source was **found** by {robot_label(outcome.finder)} after {outcome.time:.2f} s."
    return f"The source was **not found** in {outcome.time:.2f} s: {outcome.ended}."


def _outcome(outcome: Outcome) -> list[tuple[str, str]]:
    rows = [("ended", f"{outcome.ended}, {outcome.time:.2f} s")]
    if outcome.first_detection is not None:
        rows.append(("first detection", f"{outcome.first_detection:.2f} s"))
    if outcome.reached_at is not None:
        rows.append(("reached", f"{outcome.reached_at:.2f} s, by {robot_label(outcome.finder)}"))
    rows += [
        ("ticks", f"{outcome.ticks} in {outcome.wall_s:.2f} s, {outcome.ticks_per_s:.0f} per second"),
        ("truth digest", f"`{outcome.digest}`"),
    ]
    if outcome.min_pair_distance is not None:
        rows.append(("closest two robots", f"{outcome.min_pair_distance:.2f} m"))
    rows += [("fault", fault) for fault in outcome.faults]
    return rows


def _per_robot(outcome: Outcome) -> str:
    lines = ["| robot | way, m | estimate error, m |", "|---|---|---|"]
    for i, (way, error) in enumerate(zip(outcome.distance_travelled, outcome.estimate_error, strict=False)):
        lines.append(f"| {i} | {way:.1f} | {'none' if error is None else f'{error:.2f}'} |")
    return "\n".join(lines) + "\n"


def _table(rows: list[tuple[str, str]]) -> str:
    return "\n".join(["| | |", "|---|---|", *(f"| {name} | {value} |" for name, value in rows)])
