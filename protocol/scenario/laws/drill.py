"""Exercises: the motion laws alone, with references that are given and no odour."""

from __future__ import annotations

from protocol.scenario.table import Table


class Drill(Table, frozen=True):
    """The references of an exercise, the same for all robots."""
