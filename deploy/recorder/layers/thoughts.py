"""What the robots think: estimate, its uncertainty, plan, mode, and how wrong the estimate is."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray
from rerun.chunk import Chunk

from deploy.recorder import palette
from deploy.recorder.chunks import colours, pixels, strips, temporal, timeless
from deploy.recorder.decisions import PATIENCE, VALID, Decision
from deploy.recorder.layers.bodies import series
from deploy.recorder.track import Track
from protocol.messages import Belief
from protocol.scenario import Scenario

ERROR = "plots/estimate_error"
SIGMAS = 2.0
CROSS = 1.3 * np.array([[(-1.0, -1.0), (1.0, 1.0)], [(-1.0, 1.0), (1.0, -1.0)]])  # two strips, m


class ThoughtLayer:
    """Draws `Belief` messages, a row per decision."""

    def __init__(self, scenario: Scenario) -> None:
        self._n = scenario.robots
        self._source = (scenario.source.x, scenario.source.y)
        self._colours = [palette.robot_colour(i) for i in range(self._n)]
        self._faint = [palette.faint(colour, 0.45) for colour in self._colours]
        self._memory = (PATIENCE + VALID) * scenario.timing.decision
        self._past: Track | None = None  # where plans of decisions that had to wait started
        self._modes = [""] * self._n
        self._dead = [False] * self._n

    def static(self) -> Iterator[Chunk]:
        """How thoughts look."""
        yield from timeless(
            "robots/estimate", rr.Points2D.from_fields(radii=pixels(1.5), show_labels=False, draw_order=40)
        )
        yield from timeless(
            "robots/estimate/cross", rr.LineStrips2D.from_fields(radii=pixels(1.0), draw_order=41)
        )
        yield from timeless(
            "robots/uncertainty",
            rr.Ellipses2D.from_fields(line_radii=pixels(0.8), show_labels=False, draw_order=20),
        )
        yield from timeless("robots/plan", rr.LineStrips2D.from_fields(radii=pixels(0.5), draw_order=15))
        yield from timeless("robots/target", rr.Points2D.from_fields(radii=pixels(2.0), draw_order=16))
        yield from series(ERROR, self._n)
        style = rr.StateConfiguration(
            values=list(palette.MODES), colors=colours(list(palette.MODES.values()))
        )
        for i in range(self._n):
            yield from timeless(f"modes/{mode_lane(i)}", style)

    def rows(self, decisions: Sequence[Decision], track: Track) -> Iterator[Chunk]:
        """Estimates, uncertainties and plans at `decisions`; plans start where the robots are in `track`."""
        past = track if self._past is None else self._past.then(track)
        self._past = past.last(self._memory)
        if decisions:
            t = np.array([d.t for d in decisions], dtype=np.float64)
            ticks = np.array([d.tick for d in decisions], dtype=np.int64)
            sure = [[b for b in d.beliefs.values() if b.has_estimate] for d in decisions]
            yield from self._estimates(sure, t, ticks)
            yield from self._plans([list(d.beliefs.values()) for d in decisions], t, ticks, past)
            yield from temporal(ERROR, t, ticks, rr.Scalars.columns(scalars=self._errors(sure)))
        yield from self._lanes(decisions, track)

    def _estimates(
        self, sure: list[list[Belief]], t: NDArray[np.float64], ticks: NDArray[np.int64]
    ) -> Iterator[Chunk]:
        each = [len(beliefs) for beliefs in sure]
        flat = [b for beliefs in sure for b in beliefs]
        shown = np.array([self._colours[b.robot] for b in flat], dtype=np.uint32)
        h = _pairs([(b.h_x, b.h_y) for b in flat])
        yield from temporal(
            "robots/estimate", t, ticks, rr.Points2D.columns(positions=h, colors=shown).partition(each)
        )
        ends = h[:, None, None] + CROSS
        crosses = rr.LineStrips2D.columns(strips=strips(ends.reshape(-1, 2, 2)), colors=shown.repeat(2))
        yield from temporal("robots/estimate/cross", t, ticks, crosses.partition([2 * n for n in each]))
        centres = _pairs([(b.x_hat_x, b.x_hat_y) for b in flat])
        sizes = _pairs([(SIGMAS * math.sqrt(max(b.variance, 0.0)),) * 2 for b in flat])
        dim = np.array([self._faint[b.robot] for b in flat], dtype=np.uint32)
        circles = rr.Ellipses2D.columns(centers=centres, half_sizes=sizes, colors=dim)
        yield from temporal("robots/uncertainty", t, ticks, circles.partition(each))

    def _plans(
        self, spoken: list[list[Belief]], t: NDArray[np.float64], ticks: NDArray[np.int64], track: Track
    ) -> Iterator[Chunk]:
        each = [len(beliefs) for beliefs in spoken]
        flat = [b for beliefs in spoken for b in beliefs]
        shown = np.array([self._colours[b.robot] for b in flat], dtype=np.uint32)
        targets = _pairs([(b.target_x, b.target_y) for b in flat])
        yield from temporal(
            "robots/target", t, ticks, rr.Points2D.columns(positions=targets, colors=shown).partition(each)
        )
        if len(track) == 0:
            return
        rows = np.clip(np.searchsorted(track.t, t + 1e-6) - 1, 0, None).repeat(each)
        starts = track.points[rows, [b.robot for b in flat]].reshape(-1, 2)
        lines = strips(np.stack((starts, targets), axis=1))
        yield from temporal(
            "robots/plan", t, ticks, rr.LineStrips2D.columns(strips=lines, colors=shown).partition(each)
        )

    def _errors(self, sure: list[list[Belief]]) -> NDArray[np.float64]:
        """||h - x_s|| in m, (K, N); NaN where a robot has no estimate."""
        x, y = self._source
        errors = np.full((len(sure), self._n), np.nan)
        for row, beliefs in enumerate(sure):
            for b in beliefs:
                errors[row, b.robot] = math.hypot(b.h_x - x, b.h_y - y)
        return errors

    def _lanes(self, decisions: Sequence[Decision], track: Track) -> Iterator[Chunk]:
        """Modes, where they change; a robot that dies has the mode "dead"."""
        changes: dict[int, list[tuple[float, int, str]]] = {}
        for decision in decisions:
            for i, b in decision.beliefs.items():
                if b.mode != self._modes[i] and not self._dead[i]:
                    self._modes[i] = b.mode
                    changes.setdefault(i, []).append((b.t, b.tick, b.mode))
        for i in np.flatnonzero(~track.alive.all(axis=0)).tolist():
            if not self._dead[i]:
                self._dead[i] = True
                row = int(np.argmin(track.alive[:, i]))
                changes.setdefault(i, []).append((float(track.t[row]), int(track.ticks[row]), "dead"))
        for i, lane in changes.items():
            t, ticks, modes = zip(*lane, strict=True)
            column = rr.StateChange.columns(state=list(modes))
            yield from temporal(f"modes/{mode_lane(i)}", np.array(t), np.array(ticks), column)


def mode_lane(i: int) -> str:
    """Name of robot `i`'s lane among the modes."""
    return f"robot_{i}"


def _pairs(values: list[tuple[float, float]] | list[tuple[float, ...]]) -> NDArray[np.float64]:
    return np.array(values, dtype=np.float64).reshape(-1, 2)
