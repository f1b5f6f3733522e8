"""Chapter 4: the particle swarm in continuous time, in steps, and the matrix inequality of Proposition 7."""

from deploy.reproduce.chapter4 import admissible, continuous, discrete, finite_time

REPRODUCTIONS = (
    *continuous.REPRODUCTIONS,
    *finite_time.REPRODUCTIONS,
    *discrete.REPRODUCTIONS,
    *admissible.REPRODUCTIONS,
)
