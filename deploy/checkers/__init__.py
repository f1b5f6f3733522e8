"""Promises of a run, looked at afterwards: in the spirit of Jepsen, one small file each."""
