"""What `odourswarm topology` says of a graph: for a person, and as the object of `--json`.

Rules: a verdict that is bad says what to do; Greek letters only where the terminal has them.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from deploy.cli.graph_picture import draw
from protocol.topology.analysis import Analysis, Condition
from protocol.topology.fit import rounded_up
from protocol.topology.graph import Graph
from protocol.topology.named import TOPOLOGIES
from protocol.topology.robustness import MOST, robustness

MOST_EIGENVALUES = 24  # different ones that are printed


def facts(name: str, graph: Graph, analysis: Analysis, condition: Condition) -> dict[str, Any]:
    """The keys of `--json`."""
    robust = robustness(graph)
    return {
        "topology": name,
        "robots": graph.robots,
        "directed": analysis.directed,
        "edges": graph.edges,
        "links": graph.links(),
        "eigenvalues": [value.real for value in analysis.eigenvalues],
        "eigenvalues_imaginary": [value.imag for value in analysis.eigenvalues],
        "lambda_2": analysis.lambda_2,
        "connected": analysis.connected,
        "spanning_tree": analysis.spanning_tree,
        "robustness": None if robust is None else robust.r,
        "liars_withstood": None if robust is None else robust.liars,
        "condition_5_2": {
            "beta": condition.beta,
            "gamma": condition.gamma,
            "smallest_gamma": condition.bound,
            "holds": condition.holds,
        },
    }


def print_report(console: Console, name: str, graph: Graph, analysis: Analysis, condition: Condition) -> None:
    """Picture and verdicts for a person."""
    fine = console.encoding.lower().startswith("utf")
    about = f"  {TOPOLOGIES[name].about}" if name in TOPOLOGIES else ""
    kind = "directed" if analysis.directed else "undirected"
    console.print(Text.assemble((name, "bold"), about))
    console.print(f"{count(graph.robots, 'robot')}, {count(len(graph.links()), 'link')}, {kind}\n")
    picture = draw(graph, fine=fine)
    if picture is not None:
        console.print(picture, no_wrap=True, crop=False)
    else:
        degrees = sorted(len(graph.neighbours(i)) for i in range(graph.robots))
        console.print(f"too many robots to draw; each listens to {_span(degrees[0], degrees[-1])} others\n")
    rows = Table.grid(padding=(0, 3))
    for label, text, style in (*_rows(analysis, condition), ("robustness", _robustness(graph), "")):
        rows.add_row(*(Text(each if fine else plain(each), style) for each in (label, text)))
    console.print(rows)


def _rows(analysis: Analysis, condition: Condition) -> Iterator[tuple[str, str, str]]:
    """What is printed below the picture: label, text, style."""
    yield "eigenvalues of L", eigenvalues(analysis), ""
    yield "λ₂", "none, there is one robot" if analysis.lambda_2 is None else f"{analysis.lambda_2:.4g}", ""
    yield "connected", yes(analysis.connected), ""
    if analysis.directed:
        yield "spanning tree", yes(analysis.spanning_tree), ""
    yield "condition (5.2)", verdict(analysis, condition), "green" if condition.holds else "red"


def _robustness(graph: Graph) -> str:
    """How many liars the resilient fusion withstands on this graph."""
    found = robustness(graph)
    if found is None:
        return f"not looked into for more than {MOST} robots"
    return f"{found.r}-robust: the resilient fusion withstands {count(found.liars, 'liar') if found.liars else 'no liar'}"


def verdict(analysis: Analysis, condition: Condition) -> str:
    """Whether (5.2) holds, and if not, what to do."""
    gains = f"γ = {condition.gamma:g}, β = {condition.beta:g}"
    bound = rounded_up(condition.bound)
    if not analysis.connected:
        return f"does not apply: the graph must be connected ({gains})"
    if analysis.directed:
        return f"does not apply: the graph must be undirected ({gains}; γ > {bound} if it were)"
    if not analysis.nonzero:
        return "holds: one robot has nobody to agree with"
    if not condition.holds:
        return f"fails: {gains}; choose γ greater than {bound}"
    return f"holds: {gains}; γ must be greater than {bound}"


def plain(text: str) -> str:
    """`text` for a terminal that knows ASCII only."""
    for fine, plain in (("λ₂", "lambda_2"), ("γ", "gamma"), ("β", "beta"), ("×", "x"), ("\N{NO-BREAK SPACE}", " ")):
        text = text.replace(fine, plain)
    return text


def eigenvalues(analysis: Analysis) -> str:
    """Eigenvalues in ascending order, equal ones counted."""
    words = []
    for text, group in groupby(_number(value) for value in analysis.eigenvalues):
        count = sum(1 for _ in group)
        words.append(text if count == 1 else f"{text}\N{NO-BREAK SPACE}(×{count})")
    if len(words) > MOST_EIGENVALUES:
        words[MOST_EIGENVALUES - 2 : -1] = ["..."]
    return ", ".join(words)


def _number(value: complex) -> str:
    imaginary = f" {'+' if value.imag > 0 else '-'} {abs(value.imag):.4g}i" if abs(value.imag) > 1e-9 else ""
    return f"{value.real:.4g}{imaginary}"


def _span(low: int, high: int) -> str:
    return str(low) if low == high else f"{low} to {high}"


def yes(value: bool) -> str:
    """In words."""
    return "yes" if value else "no"


def count(n: int, noun: str) -> str:
    """"1 robot", "2 robots"."""
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"
