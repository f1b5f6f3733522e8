"""The schedule of a real-time world, with times given by hand."""

from itertools import pairwise

import pytest

from world_server.pace import Pace


def run(pace: Pace, steps: int, *, start: float, slow: dict[int, float] | None = None) -> list[float]:
    """When the steps are made by a world that waits as it is told; step n takes `slow[n]` s before it is made."""
    now, made = start, []
    for n in range(steps):
        now += pace.wait(now) + (slow or {}).get(n, 0.0)
        pace.step(now)
        made.append(now)
    return made


def test_steps_stand_at_whole_periods_after_the_start_and_do_not_drift():
    made = run(Pace(100.0, 0.05, 0.1), 2000, start=100.0)
    assert made[0] == pytest.approx(100.05)
    assert made[-1] == pytest.approx(200.0)


def test_a_step_that_is_a_little_late_moves_no_later_one():
    pace = Pace(0.0, 0.05, 0.1)
    made = run(pace, 10, start=0.0, slow={3: 0.02})
    assert made[3] == pytest.approx(0.22)
    assert made[4:] == pytest.approx([0.05 * (n + 1) for n in range(4, 10)])
    assert pace.slip == 0.0
    assert pace.behind == pytest.approx(0.02)


def test_a_world_that_is_behind_catches_up_without_a_burst():
    pace = Pace(0.0, 0.05, 0.2)
    made = run(pace, 20, start=0.0, slow={3: 0.15})
    gaps = [b - a for a, b in pairwise(made)]
    assert min(gaps[3:]) == pytest.approx(0.025)
    assert made[-1] == pytest.approx(1.0)
    assert pace.slip == 0.0


def test_what_is_too_far_behind_is_given_up_and_told():
    pace = Pace(0.0, 0.05, 0.1)
    made = run(pace, 40, start=0.0, slow={3: 5.0})
    assert pace.slip == pytest.approx(4.9)
    assert pace.behind == pytest.approx(5.0)
    assert made[-1] == pytest.approx(40 * 0.05 + 4.9)


def test_a_world_that_is_always_too_slow_never_piles_up_steps():
    pace = Pace(0.0, 0.05, 0.1)
    made = run(pace, 100, start=0.0, slow=dict.fromkeys(range(100), 0.08))
    assert pace.behind < 0.3
    assert made[-1] == pytest.approx(100 * 0.08, rel=0.4)
