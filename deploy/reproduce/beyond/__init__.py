"""Beyond the thesis: what a plume that meanders does to each algorithm, on the same plumes."""

from __future__ import annotations

from deploy.reproduce.beyond.gains import beyond
from deploy.reproduce.kinds import Reproduction

REPRODUCTIONS = (
    Reproduction("beyond", "Success and time against the meander of the plume, in pairs", "beyond the thesis", beyond),
)
