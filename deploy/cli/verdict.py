"""The end of a run, for a person."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from rich.text import Text

from protocol.messages import Outcome
from protocol.scenario import Scenario


def print_verdict(outcome: Outcome, scenario: Scenario, record: Path | None) -> None:
    """Found or not, by whom, how well, and what to do next; on stdout."""
    console = Console(highlight=False, soft_wrap=True)
    console.print(_headline(outcome, scenario))
    if scenario.declaration.stop == "declared":
        console.print(_declaration(outcome))
    errors = [error for error in outcome.estimate_error if error is not None]
    facts = [f"{outcome.ticks} ticks in {outcome.wall_s:.1f} s ({outcome.ticks_per_s:.0f} ticks/s)"]
    if errors:
        facts.append(f"estimates {min(errors):.1f} to {max(errors):.1f} m off")
    if outcome.min_pair_distance is not None:
        facts.append(f"robots never nearer than {outcome.min_pair_distance:.2f} m")
    console.print("  " + ", ".join(facts))
    for fault in outcome.faults:
        console.print(Text("  " + fault, style="yellow"))
    m = outcome.messages
    refused = f", {m['refused']} refused, {m['dropped']} dropped" if m["refused"] or m["dropped"] else ""
    if outcome.clock == "realtime":
        console.print(f"  {_in_time(outcome)}")
    once = " (of this run only: real time does not repeat)" if outcome.clock == "realtime" else ""
    console.print(f"  {m['sent']} messages sent{refused}; digest {outcome.digest}{once}")
    if record is not None:
        console.print(f"  odourswarm view {record}")


def _in_time(outcome: Outcome) -> str:
    """How the control periods were kept."""
    total = sum(outcome.missed)
    text = f"{total} of {outcome.ticks * len(outcome.missed)} control periods missed"
    if total:
        worst = max(range(len(outcome.missed)), key=lambda i: outcome.missed[i])
        text += f", most by robot {worst} ({outcome.missed[worst]})"
    text += f"; the world was at most {1e3 * outcome.behind:.0f} ms behind the wall clock"
    return text + (f" and gave up {outcome.slip:.2f} s of it" if outcome.slip else "")


def _headline(outcome: Outcome, scenario: Scenario) -> Text:
    if outcome.failed:
        return Text(f"Failed after {outcome.time:.1f} s: {outcome.ended}.", "bold red")
    if scenario.declaration.stop == "declared" and outcome.declared:
        return _word(outcome)
    if scenario.declaration.stop == "reached" and outcome.found:
        return Text(_found(outcome, scenario), "bold green")
    if scenario.plume.release_rate == 0.0:
        return Text(f"Ended after {outcome.time:.1f} s; there was no source to find.", "bold green")
    what = "Not found" if scenario.declaration.stop == "reached" else "No place was declared"
    if outcome.first_detection is None:
        return Text(f"{what} within {outcome.time:.1f} s: no robot met the odour.", "bold yellow")
    text = f"{what} within {outcome.time:.1f} s; the odour was first met at {outcome.first_detection:.1f} s."
    return Text(text, "bold yellow")


def _found(outcome: Outcome, scenario: Scenario) -> str:
    where = f"({scenario.source.x:g}, {scenario.source.y:g})"
    if scenario.source.stop == "concentration":
        met = f"met {scenario.source.stop_concentration:g} ppt"
        return f"Found: robot {outcome.finder} {met} after {outcome.time:.1f} s; the source is at {where}."
    return f"Found: robot {outcome.finder} reached the source at {where} after {outcome.time:.1f} s."


def _word(outcome: Outcome) -> Text:
    """What the swarm said, and how true it is."""
    place, by = f"({outcome.declared_x:.2f}, {outcome.declared_y:.2f})", outcome.declared_by
    said = f"The swarm declared the source at {place} after {outcome.declared_at:.1f} s, robot {by} first"
    off = outcome.declaration_error
    truth = "there is none." if off is None else f"{off:.2f} m off."
    return Text(f"{said}: {truth}", "bold red" if outcome.false_declaration else "bold green")


def _declaration(outcome: Outcome) -> str:
    """Where the run was when a robot reached the source, which ends nothing here."""
    if outcome.reached_at is None:
        return "  no robot came to the source"
    reached = f"  robot {outcome.finder} reached the source at {outcome.reached_at:.1f} s"
    if (delay := outcome.declaration_delay) is None:
        return reached
    return f"{reached}, {abs(delay):.1f} s {'before' if delay >= 0 else 'after'} the swarm declared it"
