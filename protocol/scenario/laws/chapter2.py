"""The decisions, laws and planners of chapter 2."""

from __future__ import annotations

from protocol.scenario.table import Table


class Pso(Table, frozen=True):
    """Particle swarm optimisation, (2.1)-(2.5), as a decision and as a direct discrete control."""


class Cpso(Table, frozen=True):
    """Charged particle swarm optimisation."""


class Consensus(Table, frozen=True):
    """The consensus law (2.7), Table 2.1."""


class Spiral(Table, frozen=True):
    """The spiral planner (2.8), (2.9)."""
