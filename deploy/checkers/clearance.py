"""No two hands came nearer to each other than the guard promises (robot_agent.control.guard).

Worked out again from the poses at every tick, dead and braked bodies included.
"""

from __future__ import annotations

from itertools import combinations
from math import cos, dist, sin

from deploy.checkers.finding import Facts
from deploy.checkers.history import History
from protocol.history.records import Moved
from protocol.scenario import proximity
from protocol.scenario.faults import Actuator
from robot_agent.control.guard import GIVE, range_needed


def stays_clear(history: History) -> Facts:
    """A fact for every tick."""
    promised = history.scenario.repulsion.keep - GIVE
    for moved in history.moved:
        near, i, j = _nearest(history, moved)
        wrong = f"robots {i} and {j} were {near:.3f} m apart {history.when(moved.tick)}; {promised:.2f} m is promised"
        yield None if near >= promised else wrong


def not_promised(history: History) -> str | None:
    """Why this run did not promise it."""
    s = history.scenario
    keep, reach = s.repulsion.keep, proximity(s)
    needed = range_needed(s.body, s.timing.tick, keep)
    reasons = [
        (s.robots < 2, "one robot has nobody to keep clear of"),
        (keep == 0.0, "repulsion.keep is 0: nobody is asked to keep clear"),
        (reach == 0.0, "the robots do not sense each other (sensors.proximity)"),
        (reach < needed, f"sensors.proximity is {reach:g}, and {needed:.2f} m are needed to stop in time"),
        (s.clock != "lockstep", "in real time a drive may come late"),
        (any(isinstance(f, Actuator) for f in s.faults), "a robot with a weak wheel brakes later than it believes"),
    ]
    reason = next((words for holds, words in reasons if holds), None)
    if reason is None and history.moved and _nearest(history, history.moved[0])[0] < keep:
        return f"robots start nearer than repulsion.keep, {keep:g} m"
    return reason


def _nearest(history: History, moved: Moved) -> tuple[float, int, int]:
    """The distance of the two hands that are nearest to each other, m, and whose they are."""
    L = history.scenario.body.hand
    hands = [(x + L * cos(theta), y + L * sin(theta)) for x, y, theta, _, _ in moved.poses]
    return min((dist(hands[i], hands[j]), i, j) for i, j in combinations(range(len(hands)), 2))
