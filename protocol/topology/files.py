"""Graphs from files.

    .toml .json    robots = 4, edges = [[0, 1], [1, 2, 0.5]], directed = false (the default)
    .csv           the adjacency matrix: row i, column j holds a_ij
    .edgelist      "i j" or "i j weight" a line; undirected
    .graphml .gml  as written by networkx, yEd, Gephi, ...; attribute "weight"

Rules: the first robot of an edge listens to the second, in every format; a third number or attribute is the weight, 1
where there is none. Nodes of .edgelist, .graphml and .gml (there the ids) are numbered from 0 or from 1 without a gap,
or have names and count in the order of the file. Whatever is wrong with a file is one sentence that starts with its
name.
"""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
from msgspec import Meta

from protocol.errors import ScenarioError
from protocol.scenario.toml_file import read_text, read_toml
from protocol.topology.graph import MOST_ROBOTS, Graph, make_graph

if TYPE_CHECKING:
    import networkx

KIND = "a graph file"
TABLE = "it must hold robots (N), edges ([[i, j], [i, j, weight], ...]) and perhaps directed (true or false)"
Robot = Annotated[int, Meta(ge=0, lt=MOST_ROBOTS)]


class GraphTable(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The content of a .toml or .json graph file."""

    robots: Annotated[int, Meta(ge=1, le=MOST_ROBOTS)]
    edges: tuple[tuple[Any, ...], ...]
    directed: bool = False


def read_graph(file: Path) -> Graph:
    """The graph in `file`; the ending of its name says the format.

    Raises: ScenarioError.
    """
    reader = SUFFIXES.get(file.suffix.lower())
    if reader is None:
        raise ScenarioError(f"{file}: the name of a graph file must end in {', '.join(SUFFIXES)}.")
    try:
        return reader(file)
    except ScenarioError as error:
        sentence = str(error)
        raise ScenarioError(sentence if sentence.startswith(f"{file}: ") else f"{file}: {sentence}") from None


def _from_toml(file: Path) -> Graph:
    return _from_table(read_toml(file, KIND))


def _from_json(file: Path) -> Graph:
    text = read_text(file, KIND)
    try:
        return _from_table(msgspec.json.decode(text))
    except msgspec.DecodeError as error:
        raise ScenarioError(f"this is not valid JSON ({error}); {TABLE}.") from None


def _from_table(content: object) -> Graph:
    try:
        table = msgspec.convert(content, GraphTable)
    except msgspec.ValidationError as error:
        raise ScenarioError(f"the content is not a graph ({_lower(error)}); {TABLE}.") from None
    for edge in table.edges:
        try:
            if len(edge) not in (2, 3):
                raise msgspec.ValidationError
            msgspec.convert(edge[:2], tuple[Robot, Robot])
            msgspec.convert(edge[2:], tuple[float, ...])
        except msgspec.ValidationError:
            raise ScenarioError(
                f"edge {list(edge)} is not allowed; it must be [i, j] or [i, j, weight], robots numbered from 0."
            ) from None
    return make_graph(table.robots, table.edges, directed=table.directed)


def _from_csv(file: Path) -> Graph:
    try:
        rows = [row for row in csv.reader(read_text(file, KIND).splitlines()) if row and not row[0].startswith("#")]
    except csv.Error as error:
        raise ScenarioError(f"this is not CSV ({error}); it must be a matrix of numbers with commas.") from None
    n = len(rows)
    for i, row in enumerate(rows):
        if len(row) != n:
            raise ScenarioError(f"row {i + 1} has {len(row)} entries and there are {n} rows; a matrix must be square.")
    edges = []
    for i, row in enumerate(rows):
        for j, entry in enumerate(row):
            try:
                weight = float(entry)
            except ValueError:
                raise ScenarioError(f'row {i + 1}, column {j + 1} is "{entry}"; it must be a number >= 0.') from None
            if weight != 0:
                edges.append((i, j, weight))
    return make_graph(n, edges)


def _from_edgelist(file: Path) -> Graph:
    import networkx as nx

    lines = [line.split("#")[0].split() for line in read_text(file, KIND).splitlines()]
    for number, fields in enumerate(lines, 1):
        if len(fields) not in (0, 2, 3):
            raise ScenarioError(f'line {number} has {len(fields)} entries; it must be "i j" or "i j weight".')
    full = [" ".join(fields if len(fields) == 3 else [*fields, "1"]) for fields in lines if fields]
    return _from_networkx(lambda: nx.parse_edgelist(full, create_using=nx.MultiGraph, data=(("weight", float),)))


def _from_graphml(file: Path) -> Graph:
    import networkx as nx

    text = read_text(file, KIND)
    return _from_networkx(lambda: nx.parse_graphml(text))


def _from_gml(file: Path) -> Graph:
    import networkx as nx

    text = read_text(file, KIND)
    return _from_networkx(lambda: nx.parse_gml(text, label="id"))


def _from_networkx(read: Callable[[], networkx.Graph[Any]]) -> Graph:
    try:
        graph = read()
        edges = [(i, j, float(data.get("weight", 1.0))) for i, j, data in graph.edges(data=True)]
    except Exception as error:  # a parser that is given a stranger's file may raise anything
        raise ScenarioError(f"it cannot be understood ({_lower(error) or 'no reason given'}); save it anew.") from None
    robot = _numbers(list(graph.nodes()))
    return make_graph(len(robot), [(robot[i], robot[j], w) for i, j, w in edges], directed=graph.is_directed())


def _numbers(nodes: list[Any]) -> dict[Any, int]:
    """Robot numbers of a file's nodes."""
    try:
        numbers = sorted((int(node), node) for node in nodes)
    except (TypeError, ValueError):
        return {node: i for i, node in enumerate(nodes)}
    first = numbers[0][0] if numbers else 0
    if first not in (0, 1) or [number for number, _ in numbers] != list(range(first, first + len(numbers))):
        given = ", ".join(str(number) for number, _ in numbers[:8])
        raise ScenarioError(f"its nodes are {given}; they must be numbered from 0 or from 1 without a gap.")
    return {node: number - first for number, node in numbers}


def _lower(error: Exception) -> str:
    text = " ".join(str(error).split())
    return (text[:1].lower() + text[1:]).rstrip(".")[:120]


SUFFIXES: dict[str, Callable[[Path], Graph]] = {
    ".toml": _from_toml,
    ".json": _from_json,
    ".csv": _from_csv,
    ".edgelist": _from_edgelist,
    ".graphml": _from_graphml,
    ".gml": _from_gml,
}
