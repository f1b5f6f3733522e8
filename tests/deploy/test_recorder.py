"""A recording holds what was said: read back with Rerun's reader and compared with the messages."""

import math
import random
from itertools import pairwise

import pytest
from recorder_helpers import RING, SOURCE, N, belief, estimate, messages, outcome, pose, ppt, record, scenario, truth

from deploy.recorder import Recording, palette
from deploy.recorder.links import BROKEN
from protocol.errors import OdourswarmError
from protocol.messages import Belief, Event, Halt, Truth

SECONDS = 20.0
ENTITIES = {
    "/arena/frame", "/arena/grid", "/arena/scale", "/arena/wind", "/arena/plume", "/source", "/events", "/run",
    "/links/heard", "/links/silent", "/links/broken", "/links/undeclared",
    "/robots/body", "/robots/heading", "/robots/trail", "/robots/plan", "/robots/target",
    "/robots/estimate", "/robots/estimate/cross", "/robots/uncertainty",
    "/plots/concentration", "/plots/concentration/threshold", "/plots/estimate_error", "/plots/speed",
    "/plots/turn_rate", "/plots/torque/left", "/plots/torque/right", "/plots/swarm",
    *(f"/modes/robot_{i}" for i in range(N)),
}  # fmt: skip


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A run in which nothing goes wrong."""
    return record(tmp_path_factory.mktemp("recording") / "whole.rrd", messages(SECONDS), flush_every=97)


@pytest.fixture(scope="module")
def wounded(tmp_path_factory):
    """A run in which robot 2 dies at 8 s."""
    said = messages(SECONDS, dies={2: 8.0})
    return record(tmp_path_factory.mktemp("recording") / "wounded.rrd", said, flush_every=97)


def test_every_entity_of_a_run_is_there_under_the_runs_own_id(whole):
    assert whole.entities() - {"/__properties"} == ENTITIES
    assert whole.ids == [("odourswarm", "story")]


def test_there_is_one_row_for_every_message(whole):
    assert len(whole.rows("/robots/body", "Points2D:positions")) == 201
    assert len(whole.rows("/plots/torque/left", "Scalars:scalars")) == 201
    assert len(whole.rows("/arena/plume", "Points2D:positions")) == 41
    assert len(whole.rows("/arena/wind", "Arrows2D:vectors")) == 41
    assert len(whole.rows("/robots/target", "Points2D:positions")) == 21
    assert len(whole.rows("/events", "TextLog:text")) == 2


def test_robots_are_drawn_where_they_are_and_look_where_they_head(whole):
    for t in (0.0, 7.3, 20.0):
        for i in range(N):
            x, y, theta = pose(i, round(t / 0.1) * 0.1)
            assert whole.at("/robots/body", "Points2D:positions", t)[i] == pytest.approx((x, y), abs=1e-4)
            ahead = whole.at("/robots/heading", "Arrows2D:vectors", t)[i]
            assert math.remainder(math.atan2(ahead[1], ahead[0]) - theta, math.tau) == pytest.approx(0.0, abs=1e-5)
            assert whole.at("/plots/concentration", "Scalars:scalars", t)[i] == pytest.approx(ppt(i, t))


def test_rows_carry_simulated_time_and_tick(whole):
    assert all(t == pytest.approx(tick * 0.05) for t, tick, _ in whole.rows("/plots/speed", "Scalars:scalars"))


def test_error_is_the_distance_of_the_estimate_to_the_source_once_there_is_one(whole):
    assert all(map(math.isnan, whole.at("/plots/estimate_error", "Scalars:scalars", 2.0)))
    errors = whole.at("/plots/estimate_error", "Scalars:scalars", 11.0)
    assert errors == pytest.approx([math.dist(estimate(i, 11.0), SOURCE) for i in range(N)])
    assert whole.at("/robots/estimate", "Points2D:positions", 2.0) == []


def test_uncertainty_is_two_sigma_around_the_filters_estimate(whole):
    said = belief(1, 220)
    centre = whole.at("/robots/uncertainty", "Ellipses2D:centers", 11.0)[1]
    half = whole.at("/robots/uncertainty", "Ellipses2D:half_sizes", 11.0)[1]
    assert centre == pytest.approx((said.x_hat_x, said.x_hat_y), abs=1e-4)
    assert half == pytest.approx([2.0 * math.sqrt(said.variance)] * 2, rel=1e-5)


def test_a_robot_has_one_colour_in_the_picture_and_in_the_plots(whole):
    colours = [palette.robot_colour(i) for i in range(N)]
    assert whole.at("/robots/body", "Points2D:colors", 5.0) == colours
    assert whole.at("/robots/estimate", "Points2D:colors", 5.0) == colours
    for plot in ("/plots/concentration", "/plots/estimate_error", "/plots/torque/right"):
        assert whole.always(plot, "SeriesLines:colors") == colours
        assert whole.always(plot, "SeriesLines:names") == [f"robot {i}" for i in range(N)]


def test_trails_are_unbroken_from_the_first_to_the_last_place(whole):
    pieces = [row[0] for _, _, row in whole.rows("/robots/trail", "LineStrips2D:strips")]
    assert all(before[-1] == after[0] for before, after in pairwise(pieces))
    assert pieces[0][0] == pytest.approx(pose(0, 0.0)[:2], abs=1e-4)
    assert pieces[-1][-1] == pytest.approx(pose(0, SECONDS)[:2], abs=1e-4)


def test_plume_and_wind_are_rounded_by_less_than_anybody_sees(whole):
    points = whole.at("/arena/plume", "Points2D:positions", 0.0)
    exact = sorted((10.0 + 0.9 * k, math.sin(0.3 * k)) for k in range(90))
    for point, true in zip(sorted(map(tuple, points)), exact, strict=True):
        assert math.dist(point, true) <= math.hypot(1 / 32, 1 / 32) + 1e-5
    assert len(whole.at("/arena/wind", "Arrows2D:vectors", 0.0)) == len(whole.always("/arena/wind", "Arrows2D:origins"))


@pytest.mark.parametrize("flush_every", [10, 97, 10**9])
def test_plans_lead_from_the_robot_to_its_target(tmp_path, flush_every):
    read = record(tmp_path / "plans.rrd", messages(60.0), flush_every=flush_every)
    plans = read.rows("/robots/plan", "LineStrips2D:strips")
    assert len(plans) == 61
    for t, tick, lines in plans:
        for i, (start, end) in enumerate(lines):
            # A decision may be drawn before the truth of its instant has come: the one before is 0.1 s old.
            assert math.dist(start, pose(i, t)[:2]) <= 0.1 * 0.8
            assert end == pytest.approx((belief(i, tick).target_x, belief(i, tick).target_y), abs=1e-4)


def test_modes_are_told_where_they_change(whole):
    lane = [(t, mode) for t, _, mode in whole.rows("/modes/robot_1", "StateChange:state")]
    assert lane == [(0.0, ["search"]), (3.0, ["trace"])]


@pytest.mark.parametrize("flush_every", [1, 7, 53])
def test_the_recording_does_not_depend_on_when_it_was_flushed(tmp_path, wounded, flush_every):
    said = messages(SECONDS, dies={2: 8.0})
    other = record(tmp_path / "other.rrd", said, flush_every=flush_every)
    assert other.entities() == wounded.entities()
    for entity, component in (
        ("/robots/body", "Points2D:positions"),
        ("/robots/body", "Points2D:colors"),
        ("/robots/trail", "LineStrips2D:strips"),
        ("/robots/estimate", "Points2D:positions"),
        ("/plots/swarm", "Scalars:scalars"),
        ("/modes/robot_2", "StateChange:state"),
        ("/events", "TextLog:text"),
    ):
        assert other.rows(entity, component) == wounded.rows(entity, component), entity
    for t in (1.0, 9.0, 15.0):
        for links in ("/links/heard", "/links/broken"):
            assert other.at(links, "LineStrips2D:strips", t) == wounded.at(links, "LineStrips2D:strips", t)


def test_a_dead_robot_turns_grey_and_its_lines_end(wounded):
    assert wounded.at("/robots/body", "Points2D:colors", 7.9)[2] == palette.robot_colour(2)
    assert wounded.at("/robots/body", "Points2D:colors", 8.0)[2] == palette.DEAD
    for plot in ("/plots/speed", "/plots/concentration"):
        assert [math.isnan(v) for v in wounded.at(plot, "Scalars:scalars", 9.0)] == [False, False, True, False]
    assert len(wounded.at("/robots/estimate", "Points2D:positions", 12.0)) == N - 1
    assert wounded.rows("/modes/robot_2", "StateChange:state")[-1][::2] == (8.0, ["dead"])


def test_links_of_a_dead_robot_are_broken_and_follow_the_robots(wounded):
    assert len(wounded.at("/links/heard", "LineStrips2D:strips", 7.9)) == N
    broken = wounded.at("/links/broken", "LineStrips2D:strips", 12.0)
    ends = {tuple(sorted(round((y - 2.0 * math.sin(1.2) + 6.0) / 4.0) for _, y in line)) for line in broken}
    assert ends == {(1, 2), (2, 3)}
    assert wounded.at("/plots/swarm", "Scalars:scalars", 12.0) == [N - 1, N, N - 2, N - 2]


def test_a_link_that_carries_nothing_is_silent_and_one_that_is_missed_is_broken(tmp_path):
    said = [truth(0, 0), *(belief(i, 0) for i in range(N)), truth(20, 1)]
    said += [belief(0, 20, links=(1, 3), heard=(3,)), belief(3, 20, links=(0,), heard=(0,)), truth(22, 2)]
    read = record(tmp_path / "links.rrd", said)
    # 0-1 is not heard by 0; 2-3 is missed by 3; 0-3 and 1-2 are as they should be.
    assert read.at("/plots/swarm", "Scalars:scalars", 1.1) == [N, N, N - 1, N - 2]
    assert len(read.at("/links/silent", "LineStrips2D:strips", 1.1)) == 1
    assert len(read.at("/links/broken", "LineStrips2D:strips", 1.1)) == 1
    assert not read.rows("/links/undeclared", "LineStrips2D:strips")


def test_a_link_that_nobody_declared_is_shown_as_such_while_it_lasts(tmp_path):
    said = [*(belief(i, 0, links=(0, 1, 2, 3)) for i in range(N)), truth(0, 0), truth(2, 1)]
    said += [*(belief(i, 20) for i in range(N)), truth(20, 2)]
    read = record(tmp_path / "links.rrd", said, flush_every=6)
    assert len(read.at("/links/undeclared", "LineStrips2D:strips", 0.1)) == 2  # 0-2 and 1-3 make the ring a clique
    assert read.at("/links/undeclared", "LineStrips2D:strips", 1.0) == []


def test_one_way_links_point_at_the_listener(tmp_path):
    one_way = tuple(((i + 1) % N, i, 1.0) for i in range(N))
    said = [*(belief(i, 0) for i in range(N)), truth(0, 0)]
    read = record(tmp_path / "directed.rrd", said, of=scenario(graph=one_way))
    heads = read.at("/links/direction", "LineStrips2D:strips", 0.0)
    tips = [head[1][1] - 0.5 * (head[0][1] + head[2][1]) for head in heads]
    # Robots stand in a column, 0 first: 0 -> 1 -> 2 -> 3 point onwards, 3 -> 0 back.
    assert sorted(math.copysign(1.0, tip) for tip in tips) == [-1.0, 1.0, 1.0, 1.0]


def test_a_robot_that_never_reports_holds_nobody_up(tmp_path):
    read = record(tmp_path / "mute.rrd", messages(SECONDS, mute=frozenset({1})), flush_every=40)
    assert len(read.rows("/robots/target", "Points2D:positions")) == 21
    errors = read.at("/plots/estimate_error", "Scalars:scalars", 15.0)
    assert [math.isnan(e) for e in errors] == [False, True, False, False]


@pytest.mark.parametrize("seed", range(4))
def test_beliefs_may_come_in_any_order_across_the_robots(tmp_path, whole, seed):
    said = messages(SECONDS)
    shuffle = random.Random(seed)
    # A belief arrives up to four decisions late, the robots' lateness differs, each robot's own come in order.
    late = [shuffle.uniform(0.0, 4.0) for _ in range(N)]
    arrival = [m.t + late[m.robot] if isinstance(m, Belief) else getattr(m, "t", SECONDS) for m in said]
    order = sorted(range(len(said)), key=lambda k: (arrival[k], k))
    read = record(tmp_path / "shuffled.rrd", [said[k] for k in order], flush_every=31)
    for entity, component in (
        ("/robots/estimate", "Points2D:positions"),
        ("/robots/uncertainty", "Ellipses2D:half_sizes"),
        ("/robots/target", "Points2D:positions"),
    ):
        assert read.rows(entity, component) == whole.rows(entity, component)


def test_lost_truth_messages_are_told_once_at_the_end(tmp_path):
    said = [m for m in messages(SECONDS) if not (isinstance(m, Truth) and m.count % 10 == 3)]
    read = record(tmp_path / "gaps.rrd", said, flush_every=50)
    texts = [text for _, _, (text,) in read.rows("/events", "TextLog:text")]
    assert [text for text in texts if "lost" in text] == ["20 of 201 truth messages were lost"]
    assert len(read.rows("/robots/body", "Points2D:positions")) == 181


def test_messages_of_another_size_are_counted_and_harm_nobody(tmp_path):
    said = messages(2.0)
    said.insert(3, Truth(1, 0.05, 500, b"123"))
    said.insert(4, belief(0, 0).__class__(*[77, *[getattr(belief(0, 0), f) for f in Belief.__struct_fields__[1:]]]))
    read = record(tmp_path / "foreign.rrd", said)
    assert len(read.rows("/robots/body", "Points2D:positions")) == 21
    assert any("did not fit" in text for _, _, (text,) in read.rows("/events", "TextLog:text"))


def test_events_have_a_level_a_colour_and_the_robots_name(tmp_path):
    said = [Event(1, 0.05, 3, "the source is found"), Event(2, 0.1, 2, "robot 2 lost at 0.10 s"), Halt(2, "found")]
    read = record(tmp_path / "events.rrd", said)
    texts = [text for _, _, (text,) in read.rows("/events", "TextLog:text")]
    levels = [level for _, _, (level,) in read.rows("/events", "TextLog:level")]
    assert texts == ["robot 3: the source is found", "robot 2 lost at 0.10 s", "halt: found"]
    assert levels == ["INFO", "WARN", "INFO"]
    assert read.rows("/events", "TextLog:color")[0][2] == [palette.robot_colour(3)]


def test_the_page_about_the_run_ends_with_its_outcome(tmp_path, whole):
    (page,) = whole.always("/run", "TextDocument:text")
    assert page.startswith("The source was **found** by robot 2")
    assert "| 2 | 1.0 | none |" in page
    (unfinished,) = record(tmp_path / "open.rrd", messages(1.0)[:-1]).always("/run", "TextDocument:text")
    assert "has not ended" in unfinished
    assert outcome().digest in page


def test_the_layout_comes_with_the_file_and_shows_all_that_is_recorded(whole):
    origins = whole.blueprint_values("ViewBlueprint:space_origin")
    shown = whole.blueprint_values("ViewContents:query")
    entities = whole.entities()
    assert origins
    assert {o for o in origins if o != "/"} <= entities | {"/modes"}
    roots = [o for o in origins if o != "/"] + [q.removesuffix("/**") for q in shown if not q.startswith("$")]
    unseen = {e for e in entities if not any(e == root or e.startswith(root + "/") for root in roots)}
    assert unseen == {"/__properties"}
    assert "sim_time" in whole.blueprint_values("TimePanelBlueprint:timeline")


def test_a_graph_with_many_links_is_drawn_less_often_and_counted_all_the_same(tmp_path):
    n = 12
    everyone = tuple((i, j, 1.0) for i in range(n) for j in range(n) if i != j)
    rows = b"\0" * (n * 9 * 8 - 8) + b"\0\0\0\0\0\0\xf0?"  # only the last one lives
    said = [Truth(2 * k, 0.1 * k, k, rows) for k in range(20)]
    read = record(tmp_path / "many.rrd", said, flush_every=7, of=scenario(robots=n, graph=everyone))
    drawn = read.rows("/links/broken", "LineStrips2D:strips")
    assert [tick for _, tick, _ in drawn] == list(range(0, 40, 4))
    assert all(len(lines) == n * (n - 1) // 2 for _, _, lines in drawn)
    assert read.at("/plots/swarm", "Scalars:scalars", 1.0) == [1, n * (n - 1) // 2, 0, 0]


def test_a_recording_that_nobody_would_see_is_refused():
    with pytest.raises(OdourswarmError, match=r"--record FILE\.rrd"):
        Recording(scenario(), path=None, view=False, run="story")


def test_a_file_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "a-file").write_text("not a folder")
    with pytest.raises(OdourswarmError, match="a-file"):
        Recording(scenario(), path=tmp_path / "a-file" / "run.rrd", view=False, run="story")


def test_closing_twice_is_closing_once_and_nothing_is_taken_afterwards(tmp_path):
    recording = Recording(scenario(), path=tmp_path / "run.rrd", view=False, run="story")
    recording.close()
    size = (tmp_path / "run.rrd").stat().st_size
    recording.take(truth(0, 0))
    recording.flush()
    recording.close()
    assert (tmp_path / "run.rrd").stat().st_size == size


def test_many_flushes_make_a_file_that_is_packed_when_it_is_closed(tmp_path, monkeypatch):
    from deploy.recorder import output

    said = messages(10.0)
    monkeypatch.setattr(output, "MANY", 10**9)
    loose = record(tmp_path / "loose.rrd", said, flush_every=5)
    monkeypatch.setattr(output, "MANY", 100)
    packed = record(tmp_path / "packed.rrd", said, flush_every=5)
    assert len(packed.chunks) < len(loose.chunks) / 3
    assert (tmp_path / "packed.rrd").stat().st_size < (tmp_path / "loose.rrd").stat().st_size
    assert packed.rows("/plots/speed", "Scalars:scalars") == loose.rows("/plots/speed", "Scalars:scalars")
    assert packed.blueprint_values("ViewBlueprint:space_origin")
    assert [path.name for path in tmp_path.iterdir() if path.name.endswith(".packing")] == []


def test_without_a_display_the_viewer_is_given_up_and_recording_goes_on(tmp_path, monkeypatch):
    import socket

    from recorder_helpers import Read

    from deploy.recorder import viewer

    with socket.create_server(("127.0.0.1", 0)) as probe:
        monkeypatch.setattr(viewer, "PORT", probe.getsockname()[1])
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(viewer.sys, "platform", "linux")
    said = []
    recording = Recording(scenario(), path=tmp_path / "run.rrd", view=True, run="story", say=said.append)
    for message in messages(2.0):
        recording.take(message)
    recording.close()
    assert len(said) == 1
    assert "no display" in said[0]
    assert len(Read(tmp_path / "run.rrd").rows("/robots/body", "Points2D:positions")) == 21


def test_the_ring_of_these_stories_is_what_links_are_counted_from():
    assert len({frozenset((i, j)) for i, j, _ in RING}) == N
    assert BROKEN == 2
