"""A graph in characters: a picture for few robots, the adjacency matrix for more.

Rules: pure, text in and text out; braille cells of 2 x 4 dots carry the lines, plain ASCII where the terminal has no
better; an arrowhead stands at the robot that listens, and only where the other does not listen back.
"""

from __future__ import annotations

from math import atan2, hypot, pi

from rich.text import Text

from deploy.cli.graph_layout import is_line, places
from protocol.topology.graph import Graph

MOST_DRAWN = 14  # robots in a picture
MOST_IN_MATRIX = 36  # robots in a matrix that fits 80 columns

_DOTS = ((0x01, 0x02, 0x04, 0x40), (0x08, 0x10, 0x20, 0x80))  # braille bits by column and row of a cell
_ARROWS = "→↗↑↖←↙↓↘"
_ASCII_ARROWS = ">/^\\</v\\"
_NODE, _EDGE, _ARROW = "bold cyan", "dim", "yellow"


class Canvas:
    """Lines of dots with characters on top."""

    def __init__(self, columns: int, rows: int, *, fine: bool) -> None:
        self.columns, self.rows, self.fine = columns, rows, fine
        self._bits = [[0] * columns for _ in range(rows)]
        self._marks: dict[tuple[int, int], tuple[str, str]] = {}  # (row, column): character, style

    def line(self, a: tuple[float, float], b: tuple[float, float]) -> None:
        """Dots from `a` to `b`, in dot coordinates."""
        steps = max(1, round(max(abs(b[0] - a[0]), abs(b[1] - a[1]))))
        for k in range(steps + 1):
            x, y = (round(p + (q - p) * k / steps) for p, q in zip(a, b, strict=True))
            if 0 <= x < 2 * self.columns and 0 <= y < 4 * self.rows:
                self._bits[y // 4][x // 2] |= _DOTS[x % 2][y % 4]

    def write(self, at: tuple[float, float], text: str, style: str) -> None:
        """`text` centred on a dot."""
        row, first = int(at[1]) // 4, int(at[0]) // 2 - len(text) // 2
        for k, character in enumerate(text):
            self._marks[row, first + k] = (character, style)

    def text(self) -> Text:
        """The canvas as text, one line per row."""
        picture = Text()
        for row, bits in enumerate(self._bits):
            for column, cell in enumerate(bits):
                dots = (chr(0x2800 + cell) if self.fine else ".") if cell else " "
                character, style = self._marks.get((row, column), (dots, _EDGE))
                picture.append(character, style)
            picture.rstrip()
            picture.append("\n")
        return picture


def draw(graph: Graph, *, fine: bool = True) -> Text | None:
    """The graph as text; None when it is too large for any picture."""
    if graph.robots <= MOST_DRAWN:
        return _picture(graph, fine=fine)
    return _matrix(graph) if graph.robots <= MOST_IN_MATRIX else None


def _picture(graph: Graph, *, fine: bool) -> Text:
    columns, rows = (6 * graph.robots - 1, 1) if is_line(graph) else (41, 17)
    canvas = Canvas(columns, rows, fine=fine)
    # In whole cells, two from either side so that the labels fit, then in dots.
    cells = [(2 + round(x * (columns - 5)), round(y * (rows - 1))) for x, y in places(graph)]
    at = [(2.0 * column, 4.0 * row + 2.0) for column, row in cells]
    for i, j in graph.links():
        canvas.line(at[i], at[j])
    listens = {(i, j) for i, j, _ in graph.edges}
    for i, j in sorted(listens):
        if (j, i) not in listens:
            _arrowhead(canvas, speaker=at[j], listener=at[i])
    for i, place in enumerate(at):
        canvas.write(place, f" {i} ", _NODE)
    return canvas.text()


def _arrowhead(canvas: Canvas, speaker: tuple[float, float], listener: tuple[float, float]) -> None:
    """An arrowhead short of the listener."""
    dx, dy = listener[0] - speaker[0], listener[1] - speaker[1]
    back = min(0.4, 8.0 / hypot(dx, dy))
    octant = round(atan2(-dy, dx) / (pi / 4)) % 8
    arrow = (_ARROWS if canvas.fine else _ASCII_ARROWS)[octant]
    canvas.write((listener[0] - back * dx, listener[1] - back * dy), arrow, _ARROW)


def _matrix(graph: Graph) -> Text:
    """The adjacency matrix: a mark in row i, column j where robot i listens to robot j."""
    width = len(str(graph.robots - 1))
    cells = graph.adjacency()
    text = Text(" " * (width + 1))
    text.append("".join(f"{j % 10:>2}" for j in range(graph.robots)), _NODE)
    for i, row in enumerate(cells):
        text.append(f"\n{i:>{width}} ", _NODE)
        for j, weight in enumerate(row):
            text.append(" #" if weight else (" \\" if i == j else " ."), "bold" if weight else _EDGE)
    text.append("\n")
    return text
