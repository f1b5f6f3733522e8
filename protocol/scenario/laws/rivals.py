"""The algorithms that the thesis compares itself with."""

from __future__ import annotations

from protocol.scenario.table import Table


class Wui(Table, frozen=True):
    """Wind utilisation, WUI-45 and WUII [Jatmiko 2007]."""


class PpsoIm(Table, frozen=True):
    """Probability PSO with information-sharing mechanism [Lu & Han 2011]."""


class Lpso(Table, frozen=True):
    """Learning PSO [Lu & Luo 2011]."""


class Ccs(Table, frozen=True):
    """A reading of the cooperative control system [Lu & Han 2011]."""
