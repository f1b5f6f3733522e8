"""Nothing was heard that was not sent, nothing was driven that was not asked for.

Every state that a robot heard stands in its sender's history with the same tick and the same content; every drive that
the world took stands in its robot's history with the same torques: at the very tick in lock-step, at most
`realtime.drive_timeout` old in real time. A robot's history says what it holds. What a planned `liar` tells while it lies
is something else, of course; that is the business of `deploy.checkers.honesty`.
"""

from __future__ import annotations

from deploy.checkers.finding import Facts
from deploy.checkers.history import History
from protocol.scenario.faults import Liar


def heard_was_sent(history: History) -> Facts:
    """A fact for every state heard and every drive taken."""
    lies = [(fault.robot, *fault.ticks(history.dt)) for fault in history.scenario.faults if isinstance(fault, Liar)]
    sent = {key: {state.content for state in states} for key, states in history.sent().items()}
    drives: dict[tuple[int, int], set[tuple[float, float]]] = {}
    for life, act in history.acts():
        drives.setdefault((life.robot, act.tick), set()).add((act.tau_left, act.tau_right))
        for j, age, content in act.heard:
            contents = sent.get((j, act.tick - age))
            state = f"robot {life.robot} heard a state of robot {j} of tick {act.tick - age} {history.when(act.tick)}"
            if contents is None:
                yield f"{state}, but robot {j} never sent one"
            else:
                lied = any(j == robot and first <= act.tick - age < end for robot, first, end in lies)
                yield None if lied or content in contents else f"{state}, but robot {j} had sent something else"
    scenario = history.scenario
    late = round(scenario.realtime.drive_timeout / history.dt) + 1 if scenario.clock == "realtime" else 0
    for moved in history.moved:
        for i, left, right in moved.drives:
            ticks = range(moved.tick - 1, moved.tick - 2 - late, -1)
            asked = any((left, right) in drives.get((i, k), ()) for k in ticks)
            says = f"the world drove robot {i} with ({left:g}, {right:g}) N m {history.when(moved.tick - 1)}"
            yield None if asked else f"{says}, but robot {i} had not asked for that"
