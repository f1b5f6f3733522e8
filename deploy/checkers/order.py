"""Time goes forward: a robot's own ticks, the ticks of every sender as they are used, the world's ticks.

Within one life of a robot the ticks that it tells and acts at grow; the states of one sender that it uses never go back
to an older one after a newer one. The world goes from tick to tick without a gap.
"""

from __future__ import annotations

from itertools import pairwise

from deploy.checkers.finding import Facts
from deploy.checkers.history import History


def ticks_grow(history: History) -> Facts:
    """A fact for every state told, every state used, every step of the world."""
    for before, after in pairwise(history.moved):
        gap = f"the world went from tick {before.tick} to tick {after.tick}"
        yield None if after.tick == before.tick + 1 else gap
    for lives in history.lives.values():
        for life in lives:
            for told, later in pairwise(life.sent):
                back = f"robot {life.robot} told its state of tick {later.tick} after that of tick {told.tick}"
                yield None if later.tick > told.tick else back
            for act, next_act in pairwise(life.acted):
                back = f"robot {life.robot} acted at tick {next_act.tick} after tick {act.tick}"
                yield None if next_act.tick > act.tick else back
    newest: dict[tuple[int, int], int] = {}  # by life and sender
    for life, act in history.acts():
        for j, age, _, _ in act.used:
            tick = act.tick - age
            last = newest.get((id(life), j), tick)
            newest[id(life), j] = tick
            if tick >= last:
                yield None
            else:
                says = f"robot {j}'s state of tick {tick}, after it had used that of tick {last}"
                yield f"robot {life.robot} used {says}, {history.when(act.tick)}"
