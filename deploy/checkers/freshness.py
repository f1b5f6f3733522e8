"""No state older than the bound was used.

    0 <= t_k - t_j <= timing.stale_after, in whole ticks

A state from the future is as wrong as an old one; only in real time, where robots are at different ticks at the same
moment, may a state be up to `trust.skew` ahead.
"""

from __future__ import annotations

from deploy.checkers.finding import Facts
from deploy.checkers.history import History


def nothing_stale_used(history: History) -> Facts:
    """A fact for every state used."""
    scenario = history.scenario
    bound = scenario.timing.stale_after
    ahead = scenario.trust.skew if scenario.clock == "realtime" else 0.0
    half = 0.5 * history.dt  # the bound is rounded to whole ticks
    for life, act in history.acts():
        for j, age, _, _ in act.used:
            old = age * history.dt
            if -ahead - half <= old <= bound + half:
                yield None
                continue
            whose = f"robot {life.robot} used robot {j}'s state of tick {act.tick - age} {history.when(act.tick)}"
            how = f"{old:.2f} s old and the bound is {bound:g} s" if old > 0 else f"{-old:.2f} s ahead of its own time"
            yield f"{whose}: it was {how}"
