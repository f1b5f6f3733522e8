"""Only neighbours' states were used: heard where the world let them be heard, along the declared graph of the moment.

A state that robot i used at tick k came from a j with an edge (i, j) in the graph that the scenario declares for tick k,
has its weight a_ij, and is one that robot i had heard. In lock-step everything that it heard stands in the world's `hears`
of that very tick; in real time, where a message has no tick of arrival, the world let i hear j at some tick from the
state's own on. (Places that neighbours pass on for others serve to keep clear; no law sums over them.)
"""

from __future__ import annotations

from deploy.checkers.finding import Facts
from deploy.checkers.graph import Declared
from deploy.checkers.history import History, Life
from protocol.history.records import Acted


def used_neighbours_only(history: History) -> Facts:
    """A fact for every state heard and every state used."""
    declared = Declared(history.scenario)
    hears = {(tick, i): states for tick, told in history.told.items() for i, states in told.hears}
    lockstep = history.scenario.clock == "lockstep"
    known: dict[int, set[tuple[int, int]]] = {}  # by life: the (sender, tick) that it heard
    for life, act in history.acts():
        heard = known.setdefault(id(life), set())
        heard |= {(j, act.tick - age) for j, age, _ in act.heard}
        for j, age, _ in act.heard:
            if lockstep:
                open_now = (j, age) in hears.get((act.tick, life.robot), ())
            else:
                window = range(act.tick - age, act.tick + 1)
                open_now = any(j == sender for k in window for sender, _ in hears.get((k, life.robot), ()))
            yield None if open_now else _says(history, life, act, j, age, "heard", "the world did not let it hear that")
        weights = declared.at(act.tick)
        for j, age, a_ij, _ in act.used:
            if (life.robot, j) not in weights:
                yield _says(history, life, act, j, age, "used", "there is no such edge in the graph")
            elif weights[life.robot, j] != a_ij:
                says = f"its weight was {a_ij:g} and the graph says {weights[life.robot, j]:g}"
                yield _says(history, life, act, j, age, "used", says)
            elif (j, act.tick - age) not in heard:
                yield _says(history, life, act, j, age, "used", "it had never heard that")
            else:
                yield None


def _says(history: History, life: Life, act: Acted, j: int, age: int, did: str, why: str) -> str:
    state = f"robot {j}'s state of tick {act.tick - age}"
    return f"robot {life.robot} {did} {state} {history.when(act.tick)}, but {why}"
