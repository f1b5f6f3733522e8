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
    if outcome.found:
        where = f"({scenario.source.x:g}, {scenario.source.y:g})"
        if scenario.source.stop == "concentration":
            met = f"met {scenario.source.stop_concentration:g} ppt"
            text = f"Found: robot {outcome.finder} {met} after {outcome.time:.1f} s; the source is at {where}."
        else:
            text = f"Found: robot {outcome.finder} reached the source at {where} after {outcome.time:.1f} s."
        return Text(text, "bold green")
    if outcome.failed:
        return Text(f"Failed after {outcome.time:.1f} s: {outcome.ended}.", "bold red")
    if scenario.plume.release_rate == 0.0:
        return Text(f"Ended after {outcome.time:.1f} s; there was no source to find.", "bold green")
    if outcome.first_detection is None:
        return Text(f"Not found within {outcome.time:.1f} s: no robot met the odour.", "bold yellow")
    text = f"Not found within {outcome.time:.1f} s; the odour was first met at {outcome.first_detection:.1f} s."
    return Text(text, "bold yellow")
