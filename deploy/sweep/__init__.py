"""Grids of runs: in memory on all cores, one row per finished run, resumable, and their summaries.

`spec` reads the file, `plan` makes the runs of it, `workers` run them, `store` keeps what is finished, `summary` says what
came out; `execute` puts them together.
"""
