"""Where a cell stands in the picture of its study.

A cell of a sweep's file may say `plot = {"states lost, %" = 30}`: the name of an axis and its place there; on several axes
where it belongs on several. The place "lambda_2" is worked out from the graph. Rules: a row of the result keeps the places
as text of JSON, so that the picture can be drawn without the sweep's file.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from deploy.sweep.spec import LAMBDA_2
from protocol.scenario import Scenario
from protocol.topology.analysis import analyse
from protocol.topology.graph import Graph

PLOT = "plot"  # the column


def places(plot: Sequence[tuple[str, float | str]], scenario: Scenario) -> str:
    """The text that a row keeps."""
    return msgspec.json.encode({axis: lambda_2(scenario) if at == LAMBDA_2 else float(at) for axis, at in plot}).decode()


def places_of(row: Mapping[str, object]) -> dict[str, float]:
    """Axis -> place of a row; empty: it is in no picture."""
    text = row.get(PLOT)
    return msgspec.json.decode(text, type=dict[str, float]) if isinstance(text, str) else {}


def lambda_2(scenario: Scenario) -> float:
    """Second smallest real part of the Laplacian's eigenvalues, with the robots where they start; of a schedule that of the
    mean graph over a period, or of its last stage when it does not repeat. 0 for one robot."""
    if not scenario.schedule:
        return analyse(Graph(scenario.robots, scenario.graph)).lambda_2 or 0.0
    from deploy.cli.graph_stages import stages_of

    return stages_of(scenario, follow=False).mean.lambda_2 or 0.0
