"""Where the robots of a graph are drawn.

Rules: places are in the unit square, y downwards; they follow from the links alone, so that equal graphs look equal.
"""

from __future__ import annotations

from math import cos, pi, sin

from protocol.topology.graph import Graph

Place = tuple[float, float]


def is_line(graph: Graph) -> bool:
    """Whether the links are 0 - 1 - ... - N-1."""
    return graph.links() == tuple((i, i + 1) for i in range(graph.robots - 1))


def is_star(graph: Graph) -> bool:
    """Whether robot 0 has a link with all and nobody else has one."""
    return graph.robots > 3 and graph.links() == tuple((0, i) for i in range(1, graph.robots))


def places(graph: Graph) -> tuple[Place, ...]:
    """Place of each robot: a line is drawn as a line, a star around its hub, anything else on a circle."""
    n = graph.robots
    if is_line(graph):
        return tuple((i / max(n - 1, 1), 0.5) for i in range(n))
    if is_star(graph):
        return ((0.5, 0.5), *_circle(n - 1))
    return _circle(n)


def _circle(n: int) -> tuple[Place, ...]:
    """`n` places on a circle, the first at the top, clockwise."""
    return tuple((0.5 + 0.5 * sin(2 * pi * i / n), 0.5 - 0.5 * cos(2 * pi * i / n)) for i in range(n))
