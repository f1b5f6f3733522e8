"""The experiment: command line, launcher, recorder, fault injection, sweeps, reproduction.

Rules of this package: it may import all others and nothing imports it; processes, threads and the wall clock live here.
"""
