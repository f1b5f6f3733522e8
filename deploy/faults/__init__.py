"""Faults by the hundred: random schedules that are valid, for benchmarks and searches for trouble."""
