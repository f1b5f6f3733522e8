"""How a recording opens: the arena large on the left, plots on the right, modes and log below."""

from __future__ import annotations

import rerun as rr
import rerun.blueprint as rrb
from rerun.blueprint.api import VisualizerLike
from rerun.encodings import EntityPathLike

from deploy.recorder import palette
from deploy.recorder.chunks import SIM_TIME
from deploy.recorder.layers.maps import EACH
from protocol.scenario import Scenario

MARGIN = 0.06  # of the arena, on every side

LEGEND = 10  # robots; more of them crowd legends and pictures


def blueprint(scenario: Scenario, *, live: bool) -> rrb.Blueprint:
    """The default layout for recordings of `scenario`; `live`: the time follows what arrives."""
    # The colours are told once: in the first plot, where nothing happens before the odour is met.
    names = rrb.Corner2D.LeftTop if scenario.robots <= LEGEND else None
    most = max(scenario.robots, len({frozenset(edge[:2]) for edge in scenario.graph}))
    counts = rrb.ScalarAxis(range=(-0.1 * most, 1.1 * most))
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(
                _arena(scenario),
                rrb.Tabs(
                    rrb.TextLogView(origin="/events", name="Events"),
                    rrb.TextDocumentView(origin="/run", name="Run"),
                    active_tab=0,
                ),
                row_shares=[0.83, 0.17],
            ),
            rrb.Vertical(
                _plot("Concentration, ppt", "/plots/concentration", legend=names),
                _plot("Estimate error, m", "/plots/estimate_error"),
                rrb.Tabs(
                    _plot("Speed, m/s", "/plots/speed"),
                    _plot("Turn rate, rad/s", "/plots/turn_rate"),
                    _plot("Left torque, N m", "/plots/torque/left"),
                    _plot("Right torque, N m", "/plots/torque/right"),
                    active_tab=0,
                ),
                _plot("Robots and links", "/plots/swarm", legend=rrb.Corner2D.LeftBottom, axis_y=counts),
                rrb.StateTimelineView(origin="/modes", name="Mode", time_view=_whole_run()),
                row_shares=[0.24, 0.17, 0.175, 0.17, 0.245],
            ),
            column_shares=[0.55, 0.45],
        ),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.TimePanel(
            state="collapsed",
            timeline=SIM_TIME,
            play_state="following" if live else "playing",
            playback_speed=1.0 if live else 10.0,
        ),
        auto_layout=False,
        auto_views=False,
    )


def _arena(scenario: Scenario) -> rrb.Spatial2DView:
    arena = scenario.arena
    across, down = MARGIN * (arena.x_max - arena.x_min), MARGIN * (arena.y_max - arena.y_min)
    # The past is kept in pieces, so that the view decides how much of it is seen.
    past = rrb.VisibleTimeRanges(
        timeline=SIM_TIME,
        start=rr.TimeRangeBoundary.infinite(),
        end=rr.TimeRangeBoundary.cursor_relative(seconds=0.0),
    )
    overrides: dict[EntityPathLike, VisualizerLike] = {
        "robots/trail": past,
        EACH: rrb.EntityBehavior(visible=False),  # the maps of single robots are there to be switched on
    }
    if scenario.robots > LEGEND:
        # Fifty circles hide everything else; they are there to be switched on.
        overrides["robots/uncertainty"] = rrb.EntityBehavior(visible=False)
    return rrb.Spatial2DView(
        origin="/",
        contents=["/arena/**", "/source/**", "/links/**", "/robots/**"],
        name="Arena",
        background=rrb.Background(color=palette.BACKGROUND),
        visual_bounds=rrb.VisualBounds2D(
            x_range=[arena.x_min - across, arena.x_max + across],
            y_range=[arena.y_min - down, arena.y_max + down],
        ),
        overrides=overrides,
    )


def _plot(
    name: str, origin: str, *, legend: rrb.Corner2D | None = None, axis_y: rrb.ScalarAxis | None = None
) -> rrb.TimeSeriesView:
    return rrb.TimeSeriesView(
        origin=origin,
        name=name,
        plot_legend=rrb.PlotLegend(legend or rrb.Corner2D.LeftTop, visible=legend is not None),
        background=rrb.archetypes.PlotBackground(color=palette.BACKGROUND, show_grid=True),
        axis_x=_whole_run(),
        axis_y=axis_y,
    )


def _whole_run() -> rrb.TimeAxis:
    ever = rr.TimeRangeBoundary.infinite()
    return rrb.TimeAxis(view_range=rr.TimeRange(start=ever, end=ever))
