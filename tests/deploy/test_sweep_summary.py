"""What a summary says, against numbers made by hand."""

import csv
import io
import json
import random
from math import sqrt

import pytest
from sweep_helpers import command

from deploy.sweep import tables
from deploy.sweep.rows import MEASURED, make_table, write_table
from deploy.sweep.summary import summarise


def row(n, *, found=True, time=100.0, algorithm="cfpso", label=None, first=10.0, nearest=1.0, **values):
    blank = dict.fromkeys(MEASURED)
    return {
        **blank, "label": label or algorithm, "algorithm": algorithm, "max_time": 1000.0, **values, "seed": n,
        "scenario_digest": f"{algorithm}{values}{n}", "found": found, "time": time if found else 1000.0,
        "first_detection": first, "min_pair_distance": nearest, "version": "0",
    }  # fmt: skip


TEN = [
    row(0, time=110.0, first=20.0),
    row(1, time=120.0, first=21.0, nearest=0.75),
    row(2, time=130.0, first=22.0),
    row(3, time=140.0, first=23.0),
    row(4, time=150.0, first=24.0),
    row(5, time=160.0, first=25.0),
    row(6, time=170.0, first=26.0),
    row(7, found=False, first=27.0, nearest=0.5),
    row(8, found=False, first=None),
    row(9, time=180.0, first=29.0, nearest=None),
]


def test_numbers_of_a_cell_are_those_made_by_hand():
    (cell,) = summarise(TEN, ["algorithm"])
    assert cell.values == {}
    assert (cell.runs, cell.found, cell.share) == (10, 8, 0.8)
    # 110, ..., 180, 1000, 1000: failures count with max_time
    assert cell.median == (150 + 160) / 2
    assert cell.mean == (110 + 120 + 130 + 140 + 150 + 160 + 170 + 180 + 1000 + 1000) / 10 == 316.0
    assert cell.std == pytest.approx(sqrt((8 * (145 - 316) ** 2 + 4200 + 2 * (1000 - 316) ** 2) / 9))
    assert cell.min_pair_distance == 0.5
    assert cell.first_detection == 24.0


def test_interval_of_the_share_is_wilsons():
    (cell,) = summarise(TEN, [])
    z, p, n = 1.959963984540054, 0.8, 10
    centre = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    assert cell.interval == pytest.approx((centre - half, centre + half))
    (all_found,) = summarise([row(n) for n in range(50)], [])
    assert all_found.interval == pytest.approx((50 / (50 + z * z), 1.0))


def test_interval_of_the_median_is_that_of_a_slow_bootstrap():
    times = [row(n, time=100.0 + n * n) for n in range(25)]
    (cell,) = summarise(times, [])
    draws = random.Random(1)
    values = sorted(each["time"] for each in times)
    medians = sorted(sorted(draws.choices(values, k=25))[12] for _ in range(20000))
    # The medians can only be one of the times: a bound is the same one, or its neighbour.
    for bound, slow in zip(cell.median_interval, (medians[500], medians[19500]), strict=True):
        assert abs(values.index(bound) - values.index(slow)) <= 1
    assert cell.median_interval[0] < cell.median < cell.median_interval[1]


def test_order_of_the_rows_changes_no_number():
    shuffled = TEN[:]
    random.Random(3).shuffle(shuffled)
    assert summarise(shuffled, []) == summarise(TEN, [])


def test_one_run_has_no_spread():
    (cell,) = summarise([row(0, found=False, first=None, nearest=None)], [])
    assert (cell.std, cell.median_interval, cell.min_pair_distance, cell.first_detection) == (None,) * 4
    assert (cell.median, cell.mean) == (1000.0, 1000.0)
    assert tables.fields(cell) == ["1", "0 (0-79)", "1000", "1000", "-", "-", "-"]


def test_columns_are_the_values_that_vary():
    rows = [row(n, case=case, robots=5) for n in range(2) for case in (1, 2)]
    assert [cell.values for cell in summarise(rows, ["algorithm", "case", "robots"])] == [{"case": 1}, {"case": 2}]


def test_label_stands_for_the_values_that_go_with_it():
    rows = [
        row(0, algorithm="pso", label="PSO-10", case=case, **{"pso.sampling": 10.0}) for case in (1, 2)
    ] + [row(0, case=case, **{"pso.sampling": 1.0}) for case in (1, 2)]
    cells = summarise(rows, ["case", "algorithm", "pso.sampling"])
    assert [tuple(cell.values.items()) for cell in cells] == [
        (("label", label), ("case", case)) for label in ("PSO-10", "cfpso") for case in (1, 2)
    ]


@pytest.fixture
def result(tmp_path):
    file = tmp_path / "r.parquet"
    write_table(make_table([*TEN, row(0, algorithm="dcs")], {"grid": "algorithm"}), file, tmp_path)
    return file


def test_formats_say_the_same(result):
    object_ = json.loads(command("--summary", result, "--json").stdout)
    first, second = object_["cells"]
    assert (object_["finished"], object_["missing"]) == (11, None)
    assert (first["algorithm"], first["runs"], first["mean_time"]) == ("cfpso", 10, 316.0)
    assert (second["runs"], second["std_time"]) == (1, None)
    rows = list(csv.DictReader(io.StringIO(command("--summary", result, "--format", "csv").stdout)))
    assert [{key: "" if value is None else str(value) for key, value in cell.items()} for cell in (first, second)] == rows
    markdown = command("--summary", result, "--format", "markdown").stdout.splitlines()
    assert markdown[0] == "| `algorithm` | runs | found, % | median, s | mean, s | std, s | nearest, m | first, s |"
    assert markdown[2].startswith("| cfpso | 10 | 80 (49-94) | 155 (")
    table = command("--summary", result).stdout.splitlines()
    assert table[0].split("  ")[0] == "algorithm"
    assert table[1].split()[:4] == ["cfpso", "10", "80", "(49-94)"]


def test_format_that_is_not_known_is_refused(result):
    ended = command("--summary", result, "--format", "html")
    assert (ended.exit_code, ended.stdout) == (2, "")
    assert ended.stderr == '--format is "html"; it must be table, csv or markdown.\n'


def word(n, *, declared=True, delay=20.0, error=0.3, false=False, reached=100.0):
    """A run that goes on until the swarm declares the source."""
    time = reached + delay if declared else 1000.0
    if not declared:
        delay = error = None
    return row(n, time=time) | {
        "reached_at": reached, "declared": declared, "declaration_delay": delay, "declaration_error": error,
        "false_declaration": false,
    }  # fmt: skip


WORDS = [word(0), word(1, delay=61.0, error=0.5), word(2, delay=-5.0, error=3.0, false=True), word(3, declared=False)]


def test_what_swarms_declared_is_summed_up_and_the_time_is_that_of_reaching():
    (cell,) = summarise(WORDS, [])
    said = cell.declared
    assert (said.runs, said.declared, said.soon, said.delay, said.error, said.false) == (4, 3, 2, 20.0, 0.5, 1)
    assert cell.median == cell.mean == 100.0
    (facts,) = tables.objects([cell])
    assert (facts["declared"], facts["declared_soon"], facts["false_declarations"]) == (3, 2, 1)
    assert tables.as_markdown([cell]).splitlines()[2].endswith("| 75 | 50 | 20 | 0.50 | 25.0 |")


def test_nothing_is_said_of_declarations_where_none_was_made():
    (cell,) = summarise(TEN, ["algorithm"])
    assert cell.declared is None
    assert "declared" not in tables.objects([cell])[0]
    assert "declared" not in tables.as_markdown([cell])
    mixed = summarise([*TEN, *(each | {"algorithm": "plume-map"} for each in WORDS)], ["algorithm"])
    assert [each["declared"] for each in tables.objects(mixed)] == [None, 3]
    assert "| - | - | - | - | - |" in tables.as_markdown(mixed)
