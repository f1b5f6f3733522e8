"""Chapter 3: the Kalman filter, the fusion and the cooperative law, each by itself."""

from deploy.reproduce.chapter3 import filtering, fusing, parallel

REPRODUCTIONS = (*filtering.REPRODUCTIONS, *fusing.REPRODUCTIONS, *parallel.REPRODUCTIONS)
