"""The robots' maps of the source: read from messages, put together, drawn in the arena."""

from __future__ import annotations

import io
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from recorder_helpers import N, messages, record
from sure_swarm import CELL, COLUMNS, PLACE, ROWS, SURE
from swarm_helpers import near_the_plume

from deploy.memory_watch import run_watched
from deploy.recorder import palette
from deploy.recorder.layers.maps import ALL, EACH, FAINTEST, LEGEND, WORDS, png
from deploy.recorder.maps import Grid, common, grid_of
from protocol.messages import BeliefMap
from robot_agent.algorithms import ALGORITHMS

SHAPE = (3, 4)


def levels(*hot: tuple[int, int]) -> np.ndarray:
    """A map whose cells (row, column) of `hot` are as likely as each other."""
    out = np.zeros(SHAPE, dtype=np.uint8)
    for cell in hot:
        out[cell] = 255
    return out


def said(robot: int, tick: int, cells: np.ndarray, **other: object) -> BeliefMap:
    values = {"rows": SHAPE[0], "levels": zlib.compress(cells.tobytes()), **other}
    return BeliefMap(robot, tick, tick * 0.05, 10.0, -2.0, 0.5, **values)


def grid(cells: np.ndarray, x: float = 10.0) -> Grid:
    return Grid(x, -2.0, 0.5, cells)


def test_a_map_survives_the_wire_row_by_row() -> None:
    cells = np.arange(12, dtype=np.uint8).reshape(SHAPE)
    read = grid_of(said(0, 0, cells))
    assert (read.x, read.y, read.cell) == (10.0, -2.0, 0.5)
    assert read.levels.tolist() == cells.tolist()


@pytest.mark.parametrize(
    "other",
    [{"rows": 5}, {"rows": 0}, {"rows": -3}, {"levels": b"junk"}, {"levels": b""}, {"levels": zlib.compress(b"")},
     {"levels": zlib.compress(bytes(1 << 20))}],
)  # fmt: skip
def test_what_is_no_map_is_left_out(other: dict) -> None:
    assert grid_of(said(0, 0, levels(), **other)) is None


@given(st.binary(max_size=40), st.integers(-5, 5))
def test_no_bytes_raise(junk: bytes, rows: int) -> None:
    grid_of(said(0, 0, levels(), levels=junk, rows=rows))


def test_robots_that_hold_the_same_map_hold_it_together() -> None:
    cells = levels((1, 2))
    cells[1, 1] = 90
    assert common({i: grid(cells) for i in range(3)}).levels.tolist() == cells.tolist()


def test_the_common_map_is_the_mean_of_the_probabilities() -> None:
    together = common({0: grid(levels((0, 0))), 1: grid(levels((0, 0), (2, 3))), 2: grid(levels((1, 1)), x=55.0)})
    # robot 2's map lies elsewhere; the probabilities are (1 + 1/2) / 2 and (0 + 1/2) / 2
    assert together.levels[0, 0] == 255
    assert together.levels[2, 3] == round(255 * (1 / 3) ** 0.5)
    assert np.count_nonzero(together.levels) == 2


def test_a_picture_holds_the_likely_cells_and_no_others_in_their_place() -> None:
    cells = levels((1, 2), (2, 3))
    cells[0, 0] = FAINTEST - 1
    part = grid(cells).cropped(FAINTEST)
    assert (part.x, part.y, part.levels.shape) == (11.0, -1.5, (2, 2))
    picture = np.array(Image.open(io.BytesIO(png(part, 0x102030FF))))
    assert picture[..., 3].tolist() == part.levels.tolist()
    assert picture[0, 0, :3].tolist() == [0x10, 0x20, 0x30]
    assert grid(levels()).cropped(FAINTEST).levels.tolist() == [[0]]


def test_maps_are_drawn_of_each_robot_and_of_all_where_they_lie(tmp_path) -> None:
    maps = [said(i, tick, levels((1, 2), (i % 3, 0))) for tick in (40, 80) for i in range(N)]
    read = record(tmp_path / "maps.rrd", sorted([*messages(20.0)[:-2], *maps], key=lambda m: m.t))
    for entity in (f"/{ALL}", *(f"/{EACH}/robot_{i}" for i in range(N))):
        assert [tick for _, tick, _ in read.rows(entity, "EncodedImage:blob")] == [40, 80]
        assert all(a < 1.0 for _, _, (a,) in read.rows(entity, "EncodedImage:opacity"))
    assert read.at(f"/{EACH}/robot_1", "Transform3D:translation", 5.0) == [[10.0, -1.5, 0.0]]
    assert read.at(f"/{EACH}/robot_1", "Transform3D:scale", 5.0) == [[0.5, 0.5, 1.0]]
    (blob,) = read.at(f"/{EACH}/robot_1", "EncodedImage:blob", 5.0)
    picture = np.array(Image.open(io.BytesIO(bytes(blob))))
    assert picture[..., 3].tolist() == [[255, 0, 255]]
    colour = palette.robot_colour(1)
    assert picture[0, 0, :3].tolist() == [(colour >> shift) & 255 for shift in (24, 16, 8)]
    assert read.always(f"/{LEGEND}", "Points2D:labels") == [WORDS]


def test_a_robot_that_shows_no_map_holds_the_others_up_only_for_a_while(tmp_path) -> None:
    maps = [said(i, 40 * k, levels((0, 0))) for k in range(1, 4) for i in (0, 1)]
    read = record(tmp_path / "few.rrd", [*messages(20.0)[:-2], *maps])
    assert len(read.rows(f"/{ALL}", "EncodedImage:blob")) == 3
    assert f"/{EACH}/robot_2" not in read.entities()


def test_without_maps_nothing_is_said_of_them(tmp_path) -> None:
    read = record(tmp_path / "none.rrd", [*messages(5.0), said(0, 20, levels(), levels=b"junk")])
    assert not any(entity.startswith("/arena/map") for entity in read.entities())


class Nobody:
    def progress(self, progress) -> None:
        """Not watched."""

    def event(self, event) -> None:
        """Not watched."""


def test_a_run_records_the_maps_of_an_algorithm_that_has_them(tmp_path, monkeypatch) -> None:
    from recorder_helpers import Read

    monkeypatch.setitem(ALGORITHMS, "sure", SURE)
    file = tmp_path / "run.rrd"
    run_watched("run", near_the_plume(algorithm="sure", max_time=12.0), Nobody(), file, view=False)
    read = Read(file)
    rows = read.rows(f"/{ALL}", "EncodedImage:blob")
    assert len(rows) >= 3
    assert all(tick % 40 == 0 for _, tick, _ in rows)
    (place,) = read.rows(f"/{ALL}", "Transform3D:translation")[-1][2]
    assert place[:2] == pytest.approx([PLACE[0] - 5.0, PLACE[1] - 3.0])
    picture = np.array(Image.open(io.BytesIO(bytes(rows[-1][2][0]))))
    assert picture.shape == (ROWS, COLUMNS, 4)
    assert read.rows(f"/{ALL}", "Transform3D:scale")[-1][2] == [[CELL, CELL, 1.0]]
