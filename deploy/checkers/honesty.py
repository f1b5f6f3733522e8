"""Everybody told its neighbours what it held: a robot with the fault `liar` does not, and here it is seen.

What a robot holds stands in its history; what it told is in what the others heard. (No robot can see this in a run: it
would need the other one's thoughts.)
"""

from __future__ import annotations

from deploy.checkers.finding import Facts
from deploy.checkers.history import History


def told_what_it_held(history: History) -> Facts:
    """A fact for every state that was heard."""
    held = {key: {state.content for state in states} for key, states in history.sent().items()}
    for life, act in history.acts():
        for j, age, content in act.heard:
            contents = held.get((j, act.tick - age))
            if contents is None:
                continue  # see `deploy.checkers.conservation`
            told = f"robot {j} told robot {life.robot} in its state of tick {act.tick - age} something else than it held"
            yield None if content in contents else f"{told}, heard {history.when(act.tick)}"
