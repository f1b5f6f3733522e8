"""Truly finite-time laws of second order, beside the printed ones."""

from __future__ import annotations

from protocol.scenario.table import Table


class DcsFt(Table, frozen=True):
    """The homogeneous finite-time form of (5.5), (5.7)."""


class CfpsoFt(Table, frozen=True):
    """The homogeneous finite-time form of (4.12)."""
