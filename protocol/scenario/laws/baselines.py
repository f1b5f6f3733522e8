"""Baselines without a decision."""

from __future__ import annotations

from protocol.scenario.table import Table


class Surge(Table, frozen=True):
    """Drive upwind; with casting when the plume is lost."""


class Walk(Table, frozen=True):
    """A random walk."""
