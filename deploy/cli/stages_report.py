"""What `odourswarm topology` says of a graph that changes: for a person, and as the object of `--json`.

Rules: as in `graph_report`; a stage that is not connected is no fault where the stages together are.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from deploy.cli.graph_picture import draw
from deploy.cli.graph_report import count, eigenvalues, facts, plain, verdict, yes
from deploy.cli.graph_stages import Part, Sample, Stages
from protocol.topology.analysis import Condition, gain_condition

MOST_PICTURES = 4
BARS = "▁▂▃▄▅▆▇█"
WIDTH = 60  # characters of the picture over time


def stages_facts(name: str, stages: Stages, gains: tuple[float, float]) -> dict[str, Any]:
    """The keys of `--json`: those of `facts` for every stage, and what they are together."""
    each = []
    for part in stages.parts:
        own = facts(part.stage.name, part.graph, part.analysis, gain_condition(part.analysis, *gains))
        each.append({"at": part.stage.at, "range": part.stage.range, **own})
    return {
        "topology": name,
        "robots": stages.joint.robots,
        "period": stages.period,
        "stages": each,
        "jointly_connected": stages.joint.connected,
        "joint_spanning_tree": stages.joint.spanning_tree,
        "mean_lambda_2": stages.mean.lambda_2,
        "over_time_of": "run" if stages.followed else "schedule",
        "over_time": [{"t": t, "lambda_2": value, "connected": whole} for t, value, whole in stages.over_time],
    }


def print_stages(console: Console, name: str, stages: Stages, gains: tuple[float, float]) -> None:
    """Pictures, a table of the stages, and what they are together."""
    fine = console.encoding.lower().startswith("utf")
    repeats = f", again every {stages.period:g} s" if stages.period else ""
    ranged = any(part.stage.range for part in stages.parts)
    console.print(Text.assemble((name, "bold"), f"  {count(len(stages.parts), 'stage')}{repeats}"))
    where = ", drawn where the robots start" if ranged else ""
    console.print(f"{count(stages.joint.robots, 'robot')}{where}\n")
    shown: set[object] = set()
    for part in stages.parts:
        if part.graph.edges not in shown and len(shown) < MOST_PICTURES:
            shown.add(part.graph.edges)
            picture = draw(part.graph, fine=fine)
            if picture is not None:
                console.print(Text(_title(part), "bold"))
                console.print(picture, no_wrap=True, crop=False)
    conditions = [gain_condition(part.analysis, *gains) for part in stages.parts]
    console.print(_table(stages, conditions, fine=fine))
    for line in _together(stages, fine=fine):
        console.print(line if fine else plain(line))
    told: set[str] = set()
    for part, condition in zip(stages.parts, conditions, strict=True):
        name = part.stage.name
        lines = (f"eigenvalues of L of {name}: {eigenvalues(part.analysis)}", verdict(part.analysis, condition))
        if lines[0] not in told:
            told.add(lines[0])
            console.print(lines[0] if fine else plain(lines[0]))
            judged = f"condition (5.2) on {name}: {lines[1]}"
            console.print(Text(judged if fine else plain(judged), "green" if condition.holds else "red"))


def _table(stages: Stages, conditions: list[Condition], *, fine: bool) -> Table:
    table = Table(box=None, padding=(0, 2), header_style="bold")
    for head in ("from s", "graph", "range m", "links", "λ₂", "connected", "(5.2)"):
        table.add_column(head if fine else plain(head), justify="left" if head == "graph" else "right")
    for part, condition in zip(stages.parts, conditions, strict=True):
        a = part.analysis
        table.add_row(
            f"{part.stage.at:g}", part.stage.name, f"{part.stage.range:g}" if part.stage.range else "-",
            str(len(part.graph.links())), "-" if a.lambda_2 is None else f"{a.lambda_2:.4g}", yes(a.connected),
            "holds" if condition.holds else "n/a" if a.directed or not a.connected else "fails",
        )  # fmt: skip
    return table


def _together(stages: Stages, *, fine: bool) -> list[str]:
    over = stages.over_time
    lines = ["", f"jointly connected: {yes(stages.joint.connected)}, all stages taken together"]
    if stages.joint.directed:
        lines.append(f"joint spanning tree: {yes(stages.joint.spanning_tree)}")
    if len(stages.parts) > 1 and stages.period and stages.mean.lambda_2 is not None:
        lines.append(f"λ₂ of the mean graph over a period: {stages.mean.lambda_2:.4g}")
    if len(over) > 1:
        what = "a run in memory" if stages.followed else "the schedule, with the robots where they start"
        values = [value for _, value, _ in over]
        lines.append(f"λ₂ along {what}, {over[0][0]:g} to {over[-1][0]:g} s: {min(values):.4g} to {max(values):.4g}")
        lines.append("  " + _bars(over, fine=fine))
        share, gap = apart(over)
        if share:
            lines.append(f"not connected {100 * share:.0f} % of the time, at most {gap:.4g} s on end")
        else:
            lines.append("connected all the time")
    return lines


def apart(over: tuple[Sample, ...]) -> tuple[float, float]:
    """For which share of the time the graph was not connected, and for how long at most on end, s."""
    total = longest = current = 0.0
    for (t, _, whole), (end, _, _) in pairwise(over):
        current = 0.0 if whole else current + end - t
        total += 0.0 if whole else end - t
        longest = max(longest, current)
    return total / max(over[-1][0] - over[0][0], 1e-12), longest


def _bars(over: tuple[Sample, ...], *, fine: bool) -> str:
    """lambda_2 over time in characters: the least value in each column, for a short gap ought to be seen."""
    first, last = over[0][0], over[-1][0]
    top = max(value for _, value, _ in over) or 1.0
    marks = BARS if fine else "_.-=+*#@"
    columns: list[float] = [top] * WIDTH
    for (t, value, _), (end, _, _) in pairwise(over):
        a, b = ((each - first) / (last - first) * WIDTH for each in (t, end))
        for column in range(int(a), max(int(a) + 1, int(b))):
            if column < WIDTH:
                columns[column] = min(columns[column], value)
    return "".join(marks[min(len(marks) - 1, int(value / top * len(marks)))] for value in columns)


def _title(part: Part) -> str:
    reach = f", within {part.stage.range:g} m" if part.stage.range else ""
    return f"{part.stage.name}{reach}, from {part.stage.at:g} s"
