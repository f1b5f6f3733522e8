"""The laws of chapter 6."""

from __future__ import annotations

from protocol.scenario.table import Table


class Ftmcs(Table, frozen=True):
    """The potential-based laws (6.2), (6.4), (6.5), Tables 6.1 and 6.2."""
