"""Graph files: every format gives the same graph, every fault is one sentence that starts with the file's name."""

from __future__ import annotations

import json
import re
from pathlib import Path

import networkx as nx
import pytest

from protocol.errors import ScenarioError
from protocol.topology.files import SUFFIXES, read_graph
from protocol.topology.graph import Graph, make_graph

LINE = make_graph(3, [(0, 1), (1, 2, 0.5)], directed=False)
ONE_WAY = make_graph(3, [(0, 1), (1, 2, 0.5)])


def is_one_sentence(text: str) -> bool:
    return "\n" not in text and text[-1] in ".?" and re.search(r"[.?!]\s+[A-Z]", text) is None


def written(tmp_path: Path, name: str, text: str) -> Path:
    file = tmp_path / name
    file.write_text(text)
    return file


GOOD = [
    ("g.toml", "robots = 3\nedges = [[0, 1], [1, 2, 0.5]]", LINE),
    ("g.TOML", "robots = 3\nedges = [[0, 1], [1, 2, 0.5]]\ndirected = true", ONE_WAY),
    ("g.toml", "robots = 2\nedges = []", make_graph(2, [])),
    ("g.json", '{"robots": 3, "edges": [[0, 1], [1, 2, 0.5]]}', LINE),
    ("g.json", '{"robots": 3, "edges": [[0, 1], [1, 2, 0.5]], "directed": true}', ONE_WAY),
    ("g.csv", "0,1,0\n1,0,0.5\n0, 0.5 ,0\n", LINE),
    ("g.csv", "# who hears whom\n0,1,0\n\n0,0,0.5\n0,0,0\n", ONE_WAY),
    ("g.edgelist", "# a line\n0 1\n1 2 0.5\n", LINE),
    ("g.edgelist", "1 2\n2 3 0.5", LINE),  # numbered from 1, as in the thesis
    ("g.edgelist", "ann bob\nbob cyd 0.5", LINE),
    ("g.gml", "graph [\n node [ id 0 ]\n node [ id 1 ]\n edge [ source 0\n target 1 ]\n]",
     make_graph(2, [(0, 1)], directed=False)),
]  # fmt: skip


@pytest.mark.parametrize(("name", "text", "graph"), GOOD)
def test_a_graph_file_gives_its_graph(tmp_path: Path, name: str, text: str, graph: Graph) -> None:
    assert read_graph(written(tmp_path, name, text)) == graph


@pytest.mark.parametrize("graph", [LINE, ONE_WAY], ids=["undirected", "directed"])
@pytest.mark.parametrize("ending", ["graphml", "gml"])
def test_what_networkx_writes_is_read_again(tmp_path: Path, graph: Graph, ending: str) -> None:
    theirs = graph.to_networkx() if graph is ONE_WAY else graph.to_networkx().to_undirected()
    file = tmp_path / f"g.{ending}"
    {"graphml": nx.write_graphml, "gml": nx.write_gml}[ending](theirs, file)
    assert read_graph(file) == graph


def test_the_first_robot_of_an_edge_listens_in_every_format(tmp_path: Path) -> None:
    wanted = make_graph(2, [(0, 1)])
    texts = {
        "g.toml": "robots = 2\nedges = [[0, 1]]\ndirected = true",
        "g.json": json.dumps({"robots": 2, "edges": [[0, 1]], "directed": True}),
        "g.csv": "0,1\n0,0",
        "g.gml": "graph [ directed 1\n node [ id 0 ]\n node [ id 1 ]\n edge [ source 0\n target 1 ]\n]",
        "g.graphml": '<graphml><graph edgedefault="directed"><node id="0"/><node id="1"/>'
        '<edge source="0" target="1"/></graph></graphml>',
    }
    for name, text in texts.items():
        assert read_graph(written(tmp_path, name, text)) == wanted, name


BAD = [
    ("g.toml", "robots = 3", "the content is not a graph (object missing required field `edges`); it must hold robots"),
    ("g.toml", "robots = 0\nedges = []", "the content is not a graph (expected `int` >= 1"),
    ("g.toml", "robots = 3\nedgs = []\nedges = []", "the content is not a graph (object contains unknown field"),
    ("g.toml", "robots = 3\nedges = [[0]]", "edge [0] is not allowed; it must be [i, j] or [i, j, weight]"),
    ("g.toml", "robots = 3\nedges = [[0, 1, 1, 1]]", "edge [0, 1, 1, 1] is not allowed"),
    ("g.toml", "robots = 3\nedges = [['a', 1]]", "edge ['a', 1] is not allowed"),
    ("g.toml", "robots = 3\nedges = [[0, 1, 'a']]", "edge [0, 1, 'a'] is not allowed"),
    ("g.toml", "robots = 3\nedges = [[0, 3]]", "edge [0, 3] names robot 3; the robots must be numbered 0 to 2."),
    ("g.toml", "robots = 3\nedges = [[0, 1], [1, 0]]", "edge [1, 0] is given twice; every edge must be given once,"),
    ("g.toml", "robots = 3\nedges = [[0, 1, nan]]", "edge [0, 1] has weight nan; it must be a number > 0."),
    ("g.toml", "robots =", "this is not valid TOML, "),
    ("g.json", "{", "this is not valid JSON ("),
    ("g.json", '{"robots": 2, "edges": [[0, 1, NaN]]}', "this is not valid JSON ("),
    ("g.json", "[]", "the content is not a graph ("),
    ("g.csv", "0,1\n1,0,1", "row 2 has 3 entries and there are 2 rows; a matrix must be square."),
    ("g.csv", "0,x\n1,0", 'row 1, column 2 is "x"; it must be a number >= 0.'),
    ("g.csv", "0,-1\n1,0", "edge [0, 1] has weight -1; it must be a number > 0."),
    ("g.csv", "1,1\n1,0", "edge [0, 0] joins a robot to itself; an edge must join two robots."),
    ("g.csv", "", "there are 0 robots; there must be 1 to 1000."),
    ("g.edgelist", "0 1\n1 2 3 4", 'line 2 has 4 entries; it must be "i j" or "i j weight".'),
    ("g.edgelist", "0 1\n1 3", "its nodes are 0, 1, 3; they must be numbered from 0 or from 1 without a gap."),
    ("g.edgelist", "0 1\n1 0", "edge [0, 1] is given twice; every edge must be given once, for both directions."),
    ("g.edgelist", "0 1 x", "it cannot be understood (failed to convert"),
    ("g.graphml", "<graphml>", "it cannot be understood ("),
    ("g.graphml", "", "it cannot be understood ("),
    ("g.gml", "graph [ node [", "it cannot be understood ("),
    ("g.gml", "", "it cannot be understood ("),
    ("g.png", "", "the name of a graph file must end in .toml, .json, .csv, .edgelist, .graphml, .gml."),
]  # fmt: skip


@pytest.mark.parametrize(("name", "text", "start"), BAD)
def test_a_faulty_graph_file_is_one_sentence(tmp_path: Path, name: str, text: str, start: str) -> None:
    file = written(tmp_path, name, text)
    with pytest.raises(ScenarioError) as caught:
        read_graph(file)
    assert str(caught.value).startswith(f"{file}: {start}")
    assert is_one_sentence(str(caught.value))


@pytest.mark.parametrize("ending", SUFFIXES)
def test_a_graph_file_that_cannot_be_read_is_one_sentence(tmp_path: Path, ending: str) -> None:
    missing, folder, noise = tmp_path / f"a{ending}", tmp_path / f"b{ending}", tmp_path / f"c{ending}"
    folder.mkdir()
    noise.write_bytes(b"\xff\xfe\x00")
    for file, reason in ((missing, "there is no such file"), (folder, "this is a directory"), (noise, "byte 0 is not")):
        with pytest.raises(ScenarioError) as caught:
            read_graph(file)
        assert str(caught.value).startswith(f"{file}: {reason}")
        assert is_one_sentence(str(caught.value))
