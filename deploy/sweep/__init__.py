"""Grids of runs: in memory on all cores, one row per finished run, resumable, and their summaries."""
