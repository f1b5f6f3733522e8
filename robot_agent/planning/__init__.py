"""Planners: where to go, given the decision? One file each."""
